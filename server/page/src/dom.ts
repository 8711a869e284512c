// Small help with elements.
export function $<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

type Child = Node | string | null | undefined;
type Properties = Record<string, unknown>;

/** An element with attributes (on... : listeners) and children. */
export function h(tag: string, properties: Properties = {}, ...children: Child[]): HTMLElement {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value as EventListener);
    else if (name === 'class') element.className = String(value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined));
  return element;
}

export function button(text: string, act: () => void, properties: Properties = {}): HTMLElement {
  return h('button', { type: 'button', onclick: act, ...properties }, text);
}

/** Three significant digits, thousands apart. */
export function figure(value: number, digits = 3): string {
  if (Number.isInteger(value)) return value.toLocaleString('en').replaceAll(',', '\u202f');
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return scientific(value, digits);
  return String(Number(value.toPrecision(digits)));
}

// 1.7 × 10⁻⁴
function scientific(value: number, digits: number): string {
  const [mantissa, exponent] = value.toExponential(digits - 1).split('e') as [string, string];
  const raised = [...String(Number(exponent))].map((c) => (c === '-' ? '\u207b' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[Number(c)])).join('');
  return `${Number(mantissa)}\u202f×\u202f10${raised}`;
}
