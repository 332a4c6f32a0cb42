import { signal } from "@preact/signals-core";
import type { Signal } from "@preact/signals-core";

/**
 * Decorates a property that effects and computed signals follow: they run again when it is given another value. They do
 * not notice a change inside of its value.
 */
export function observed<Owner extends object, Value>(
  _target: ClassAccessorDecoratorTarget<Owner, Value>,
  _context: ClassAccessorDecoratorContext<Owner, Value>,
): ClassAccessorDecoratorResult<Owner, Value> {
  const signals = new WeakMap<Owner, Signal<Value>>();
  const signalOf = (owner: Owner): Signal<Value> => signals.get(owner) as Signal<Value>;
  return {
    init(value) {
      signals.set(this, signal(value));
      return value;
    },
    get() {
      return signalOf(this).value;
    },
    set(value) {
      signalOf(this).value = value;
    },
  };
}
