// The sections of figures of a run, with what each shows.
import type { Summary, Trust } from "./summary";
import type { Section } from "./types";

const LAW: Section = { id: "law", title: "Interface law", text: "Response of the interface law to a sequence of openings and closings." };
const BEAMS: Section = { id: "beams", title: "Section forces of beams", text: "Envelopes along the beams, compared with those of the bonded reference run." };

const OF_STATICS: Section[] = [
  { id: "rest", title: "State under the static loads", text: "State of the base at the end of the static stages." },
  { id: "response", title: "Response", text: "Displacements of the top and of the base at every load step." },
  { id: "interface", title: "Interface", text: "Forces in the interface and its opening at every load step." },
  BEAMS,
  LAW,
];

/** A section without figures is not shown. `floors_warning`: what is to be known of the floor spectra of these runs; may be empty. */
export function sections_of(summary: Summary, trust: Trust | undefined, floors_warning: string, statics: boolean): Section[] {
  const groups = new Set(summary.runs.map((run) => run.group));
  if (statics) return OF_STATICS;
  const floors = "Response spectra of the floor accelerations: the largest pseudo-acceleration of equipment with a given frequency and damping.";
  return [
    { id: "rest", title: "Residual state", text: "State of the base at the end of the run, compared with the state before the shaking." },
    { id: "loads", title: "Loads", text: "Loads on the structure over time." },
    { id: "motions", title: "Ground motions", text: "Recorded and generated ground motions that excite the model." },
    { id: "response", title: "Response", text: "Displacements and velocities of the top and of the base." },
    {
      id: "interface", title: "Interface",
      text: "Forces in the interface and its opening. The uplifted area is the area with a gap; zero pressure alone does not count as uplift.",
    },
    BEAMS,
    { id: "floors", title: "Floor spectra", text: floors + (floors_warning ? ` Warning: ${floors_warning}` : "") },
    ...(groups.size > 1
      ? [{
          id: "others", title: "Other dampings and motions",
          text: "The same variants with the other dampings and motions of the case. Without damping, numerical errors of the velocity remain visible.",
        }]
      : []),
    ...(trust ? [{ id: "trust", title: "Trust bands of the floor spectra", text: "Range of each floor spectrum over all runs in which one computational choice was changed." }] : []),
    {
      id: "energy", title: "Energy",
      text: "The energy balance is evaluated at every step. Its residual is the numerical energy error: energy that the computation created (positive) or lost (negative).",
    },
    LAW,
  ];
}
