import { effect } from "@preact/signals-core";
import { live, liveText } from "./bindings";
import { h, uniqueId } from "./dom";
import { NumberField } from "./number_field";
import type { NumberOptions, Taker } from "./number_field";

interface ControlOptions {
  title?: string; // the tooltip
  hidden?: () => boolean;
  blocked?: () => string; // why the control is disabled, instead of the group's reason
}

type ChoiceOptions<Value> = Taker<Value> &
  ControlOptions & {
    options: Record<string, Value>; // by their names
    other?: string; // shown for values that are none of the options; the user cannot choose it
    get(): Value | undefined; // state that the control follows
  };

const never = (): boolean => false;

/**
 * A group of controls, which follow state. `id` of a control: for tests and style sheets. `name` of a control: for the
 * user; a function follows state.
 */
export class Controls {
  readonly body = h("div", { class: "body" });

  /** `blocked`: why the controls are disabled; empty: they are enabled. */
  constructor(private readonly blocked = (): string => "") {}

  action(id: string, name: string, act: () => void, options: ControlOptions = {}): HTMLButtonElement {
    const button = h("button", { type: "button", "data-testid": id, click: act }, name);
    live(button, { disabled: () => this.reason(options) !== "" });
    this.add(id, options, button);
    return button;
  }

  choice<Value>(id: string, name: string, options: ChoiceOptions<Value>): HTMLSelectElement {
    const values = Object.values(options.options);
    const list = Object.keys(options.options).map((one) => h("option", {}, one));
    if (options.other) list.push(h("option", { disabled: true, hidden: true }, options.other));
    const select = h("select", { id: uniqueId("choice"), "data-testid": id }, ...list);
    live(select, { disabled: () => this.reason(options) !== "" });
    const show = (): void => {
      const index = values.findIndex((value) => value === options.get());
      select.selectedIndex = index < 0 && options.other ? values.length : index;
    };
    effect(show);
    const take = async (value: Value): Promise<void> => {
      if ("set" in options) return options.set(value);
      const outcome = await options.send(value);
      if (outcome.case !== "applied") show(); // the value that the server has
    };
    select.addEventListener("change", () => void take(values[select.selectedIndex] as Value));
    this.add(id, options, h("label", { for: select.id }, name), h("span", { class: "pick" }, select));
    return select;
  }

  number(id: string, name: string | (() => string), options: NumberOptions & ControlOptions): NumberField {
    const field = new NumberField(id, options, () => this.reason(options) !== "");
    const { input, slider } = field;
    const label = h("label", { id: uniqueId("name"), for: (input.id = uniqueId("number")) });
    label.append(typeof name === "string" ? name : liveText(name));
    slider?.setAttribute("aria-labelledby", label.id);
    const row = this.add(id, options, label, ...(slider ? [slider] : []), input);
    row.after(field.message);
    return field;
  }

  /** Why a control is disabled; empty: it is enabled. */
  private reason({ blocked = this.blocked }: ControlOptions): string {
    return blocked();
  }

  private add(id: string, options: ControlOptions, ...children: HTMLElement[]): HTMLElement {
    const row = h("div", { class: "control", "data-control": id }, ...children);
    live(row, {
      title: () => this.reason(options) || (options.title ?? ""),
      hidden: options.hidden ?? never,
    });
    this.body.append(row);
    return row;
  }
}
