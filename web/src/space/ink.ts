// Colours of the space view and of the maps. Print always uses the light set.
import type { Theme } from "../theme";

export interface Ink {
  card: string;
  text: string;
  soft: string;
  line: string;
  /** Ground parts and the others take these in turn. */
  ground: string[];
  structure: string[];
  edge: string;
  steel: string;
  body: string;
  mass: string;
  held: string;
  absorbing: string;
  open: string;
  /** The boundary between open and closed in the maps. */
  boundary: string;
  /** Map colour of closed points. */
  closed: string;
  gap: Ramp;
  pressure: Ramp;
  tension: Ramp;
  slip: Ramp;
  displacement: Ramp;
}

export type Rgb = [number, number, number];

export const rgb = (hex: string): Rgb => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)) as Rgb;

/** Colours from 0 to 1, linear between stops at equal distances. */
export class Ramp {
  private readonly table_ = new Uint8ClampedArray(256 * 3);
  readonly stops: string[];

  constructor(...stops: string[]) {
    this.stops = stops;
    const colours = stops.map(rgb);
    for (let i = 0; i < 256; i++) {
      const along = (i / 255) * (colours.length - 1);
      const k = Math.min(colours.length - 2, Math.floor(along));
      const [a, b] = [colours[k] as Rgb, colours[k + 1] as Rgb];
      for (let c = 0; c < 3; c++) this.table_[3 * i + c] = (a[c] as number) + (along - k) * ((b[c] as number) - (a[c] as number));
    }
  }

  at(part: number): Rgb {
    const i = 3 * Math.round(255 * Math.min(1, Math.max(0, part || 0)));
    return [this.table_[i] as number, this.table_[i + 1] as number, this.table_[i + 2] as number];
  }

  css(part: number): string {
    return `rgb(${this.at(part).join()})`;
  }
}

export const LIGHT: Ink = {
  card: "#ffffff",
  text: "#1a2026",
  soft: "#5a646d",
  line: "#c3cad0",
  ground: ["#c8b48c", "#ab9168", "#94826a", "#bfae9a"],
  structure: ["#b3c1cd", "#8fa5b8", "#c9cfc4", "#a6b3ab"],
  edge: "#22303c",
  steel: "#38434d",
  body: "#9fb0be",
  mass: "#38434d",
  held: "#3d7a4a",
  absorbing: "#7d53b5",
  open: "#d1570b",
  boundary: "#10161b",
  closed: "#dde4ea",
  gap: new Ramp("#fde6d2", "#f6a868", "#d1570b", "#6e2405"),
  pressure: new Ramp("#f3f6f9", "#9cc6e4", "#2f86bf", "#0b4775", "#041f38"),
  tension: new Ramp("#f3f6f9", "#d8a9d0", "#93307e", "#44103a"),
  slip: new Ramp("#eef4f0", "#8fd0b6", "#1f8f6a", "#07402d"),
  displacement: new Ramp("#2b4a7c", "#5a7190", "#8f9397", "#c0a873", "#e8b93a", "#fbe36a"),
};

export const DARK: Ink = {
  card: "#1a1e22",
  text: "#e3e7ea",
  soft: "#9ba6af",
  line: "#434c54",
  ground: ["#a08c62", "#86704e", "#6f6250", "#948672"],
  structure: ["#93a4b3", "#6d8498", "#a3aca0", "#82928b"],
  edge: "#0c1116",
  steel: "#d5dce2",
  body: "#7d8f9e",
  mass: "#d5dce2",
  held: "#6fb880",
  absorbing: "#b794e6",
  open: "#ff9455",
  boundary: "#ffffff",
  closed: "#2b3239",
  gap: new Ramp("#4a2c19", "#a3501d", "#f08a45", "#ffd9b8"),
  pressure: new Ramp("#222930", "#1f5680", "#3b93cf", "#9ad3fb", "#eaf7ff"),
  tension: new Ramp("#222930", "#7d3a70", "#d583c6", "#fbe3f5"),
  slip: new Ramp("#222930", "#1d6a50", "#43bd92", "#d2f7e8"),
  displacement: new Ramp("#4d6da3", "#7489a6", "#9da0a3", "#c9b17c", "#edc04a", "#fdea8a"),
};

export const ink_of = (theme: Theme): Ink => (theme === "dark" ? DARK : LIGHT);
