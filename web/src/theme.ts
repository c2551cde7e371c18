// Light and dark. Follows the system until the reader chooses; the choice is kept where the browser allows it.

export type Theme = "light" | "dark";
const KEY = "uplift-report-theme";

const dark_query = (): MediaQueryList => matchMedia("(prefers-color-scheme: dark)");

// Storage is refused for files in some browsers; the toggle then lasts as long as the page.
function stored(): Theme | null {
  try {
    const value = localStorage.getItem(KEY);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null;
  }
}

function store(theme: Theme): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // The page works without a memory.
  }
}

export class ThemeSwitch {
  private chosen_: Theme | null = stored();
  private readonly listeners_: ((theme: Theme) => void)[] = [];

  constructor() {
    dark_query().addEventListener("change", () => this.apply());
    this.apply();
  }

  get theme(): Theme {
    return this.chosen_ ?? (dark_query().matches ? "dark" : "light");
  }

  toggle(): void {
    this.chosen_ = this.theme === "dark" ? "light" : "dark";
    store(this.chosen_);
    this.apply();
  }

  on_change(listener: (theme: Theme) => void): void {
    this.listeners_.push(listener);
  }

  private apply(): void {
    const theme = this.theme;
    document.documentElement.dataset["theme"] = theme;
    for (const listener of this.listeners_) listener(theme);
  }
}

/** A colour of the style sheet, for canvases. */
export function css_colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
