// Which runs are shown in every figure. Charts and the bar of runs listen.

export class Runs {
  readonly names: string[];
  private readonly hidden_ = new Set<string>();
  private readonly listeners_: (() => void)[] = [];
  private readonly slots_ = new Map<string, number>();
  private readonly failed_: Set<string>;

  constructor(names: string[], failed: Set<string>) {
    this.names = names;
    this.failed_ = failed;
    names.forEach((name, i) => this.slots_.set(name, i));
  }

  /** Palette position of a run. */
  slot(name: string): number {
    return this.slots_.get(name) ?? 0;
  }

  failed(name: string): boolean {
    return this.failed_.has(name);
  }

  hidden(name: string | undefined): boolean {
    return name !== undefined && this.hidden_.has(name);
  }

  set_hidden(names: string[], hidden: boolean): void {
    for (const name of names) {
      if (hidden) this.hidden_.add(name);
      else this.hidden_.delete(name);
    }
    for (const listener of this.listeners_) listener();
  }

  on_change(listener: () => void): void {
    this.listeners_.push(listener);
  }
}
