// Figures made from summary.json and trust.json: envelopes of section forces along the beams, bands of the floor spectra, stiffness sweep.
import { percent, significant } from "./quantity";
import type { BeamEnvelope, RunSummary, Summary, Trust, TrustSpectrum } from "./summary";
import type { Chart, RawChart, Series } from "./types";

/** What the case states for single figures: where they come from, and a caption of its own. */
export type Figures = Record<string, { origin: string; caption?: string }>;

const ADDED = "added by uplift";

/** A chart with the origin and the caption that the case states. */
export function stated(chart: RawChart, figures: Figures): Chart {
  const figure = figures[chart.id];
  return { ...chart, caption: figure?.caption ?? chart.caption, origin: figure?.origin ?? chart.origin ?? ADDED };
}

type Component = "moment" | "shear" | "axial";
interface Figure {
  component: Component;
  title: string;
  caption: string;
  unit: string;
}

const AXIAL: Figure = { component: "axial", title: "Axial force", caption: "Largest and smallest axial force of every section over all steps. Tension is positive.", unit: "N" };
const IN_THE_PLANE: Figure[] = [
  {
    component: "moment", title: "Bending moment", unit: "N m",
    caption: "Largest and smallest bending moment of every section over all steps. Positive: tension on the right of the direction in which the beam runs.",
  },
  {
    component: "shear", title: "Shear force", unit: "N",
    caption: "Largest and smallest shear force of every section over all steps. Positive: what lies beyond the section pushes to the left of the direction in which the beam runs.",
  },
  AXIAL,
];
const IN_SPACE: Figure[] = [
  { component: "moment", title: "Bending moment", unit: "N m", caption: "Largest bending moment of every section over all steps, of both axes together." },
  { component: "shear", title: "Shear force", unit: "N", caption: "Largest shear force of every section over all steps, of both axes together." },
  AXIAL,
];

/** Along an upright beam its height, else the distance from its beginning. */
function is_upright({ along, elevation }: BeamEnvelope): boolean {
  const range = Math.max(...elevation.value) - Math.min(...elevation.value);
  return range > 0.5 * (along.value[along.value.length - 1] ?? 0);
}

function beam_chart(figure: Figure, which: number, runs: RunSummary[], first: BeamEnvelope): RawChart {
  const height = is_upright(first);
  const magnitude = first.torsion !== undefined && figure.component !== "axial";
  const series = runs.flatMap((run): Series[] => {
    const envelope = run.beam_envelopes?.[which];
    if (!envelope) return [];
    const style = { run: run.label, y: (height ? envelope.elevation : envelope.along).value, ...(run.bonded ? { dash: true } : {}), ...(run.status === "failed" ? { failed: true } : {}) };
    const { max, min } = envelope[figure.component];
    if (magnitude) return [{ label: run.label, x: max, ...style }];
    return [{ label: `${run.label}, largest`, x: max, ...style }, { label: `${run.label}, smallest`, x: min, ...style }];
  });
  return {
    id: `beam_${figure.component}_${which + 1}`, section: "beams", title: `${figure.title}: ${first.beam}`, caption: figure.caption,
    x: { label: figure.title, unit: figure.unit }, y: { label: height ? "Height" : "Distance along the beam", unit: "m" }, series,
  };
}

/** Of the runs that are compared with the first one. */
function beam_charts(summary: Summary): RawChart[] {
  const runs = summary.runs.filter((run) => run.group === summary.runs[0]?.group);
  return (runs[0]?.beam_envelopes ?? []).flatMap((first, which) =>
    (first.torsion === undefined ? IN_THE_PLANE : IN_SPACE).map((figure) => beam_chart(figure, which, runs, first)));
}

function trust_chart(spectrum: TrustSpectrum, accepted: number): RawChart {
  const { floor, damping, frequencies, limited_by, speaks_to } = spectrum;
  const curve = (label: string, y: (number | null)[], dash: boolean): Series => ({ label, x: frequencies, y, ...(dash ? { dash } : { run: label }) });
  return {
    id: `trust_${floor}_${significant(100 * damping, 6)}`,
    section: "trust",
    title: `Floor ${floor}, ${percent(damping)} damping`,
    caption: limited_by === "" ? `All runs lie within ${percent(accepted)} of the case at all frequencies.` : `Reliable up to ${significant(speaks_to, 3)} Hz, limited by the ${limited_by}.`,
    x: { label: "Frequency", unit: "Hz", log: true },
    y: { label: "Pseudo-acceleration", unit: "m/s2" },
    series: [curve("case", spectrum.value, false), curve("smallest of all runs", spectrum.least, true), curve("largest of all runs", spectrum.most, true)],
  };
}

function sweep_chart(summary: Summary): RawChart[] {
  const rows = summary.stiffness_sweep ?? [];
  if (rows.length === 0) return [];
  const least = 1e-16;
  const curve = (label: string, share: (row: (typeof rows)[number]) => number | null, dash: boolean): Series => ({
    label, x: rows.map((row) => row.k_F), y: rows.map((row) => Math.max(share(row) ?? NaN, least)), ...(dash ? { dash } : {}),
  });
  return [{
    id: "stiffness_sweep",
    section: "energy",
    title: "Spurious energy against the stiffness of the joint",
    caption: "Largest spurious energy divided by the external work, for the end-of-step traction and the path-averaged traction. Values below 1e-16 are drawn at 1e-16.",
    x: { label: "Stiffness ratio k F", unit: "1", log: true },
    y: { label: "Spurious energy", unit: "1", log: true },
    series: [curve("path average", (row) => row.created_share_path, false), curve("end of step", (row) => row.created_share_end, true)],
  }];
}

/** All of them, after those of the program. */
export function charts_of(summary: Summary, trust: Trust | undefined, charts: RawChart[], figures: Figures): Chart[] {
  const all = [...charts, ...beam_charts(summary), ...(trust?.spectra ?? []).map((spectrum) => trust_chart(spectrum, trust?.spectrum_band ?? 0)), ...sweep_chart(summary)];
  return all.map((chart) => stated(chart, figures));
}
