// The bar that shows and hides runs in all figures at once; it stays visible while figures scroll.
import { swatch } from "./chart";
import { h } from "./dom";
import { DASHES, FAILED_DASH, SLOTS } from "./palette";
import type { Runs } from "./runs";

export function run_bar(runs: Runs): HTMLElement {
  const chips = h("div", { class: "run-chips", role: "group", "aria-label": "Runs in every figure" });
  const failed = runs.names.filter((name) => runs.failed(name));
  const update = (): void => {
    const focus = [...chips.children].indexOf(document.activeElement as Element);
    chips.replaceChildren(
      ...runs.names.map((name) => {
        const slot = runs.slot(name);
        const dash = runs.failed(name) ? FAILED_DASH : (DASHES[Math.floor(slot / SLOTS) % DASHES.length] ?? []);
        const flip = (): void => runs.set_hidden([name], !runs.hidden(name));
        return h("button", { type: "button", class: "key", "aria-pressed": String(!runs.hidden(name)), onclick: flip }, swatch(slot, dash), h("span", {}, name));
      }),
    );
    (chips.children[focus] as HTMLElement | undefined)?.focus({ preventScroll: true });
  };
  runs.on_change(update);
  update();
  const only_sound = (): void => {
    runs.set_hidden(runs.names, false);
    runs.set_hidden(failed, true);
  };
  return h(
    "div",
    { class: "run-bar" },
    h("span", { class: "run-bar-name" }, "Runs"),
    chips,
    h("span", { class: "run-bar-tools" },
      h("button", { type: "button", onclick: () => runs.set_hidden(runs.names, false) }, "All"),
      failed.length > 0 && failed.length < runs.names.length ? h("button", { type: "button", onclick: only_sound }, "Without failed runs") : null),
  );
}
