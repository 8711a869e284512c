// The form: options as it says them, sizes on groups, presets and what they come to.
import type { Options } from './api';
import { cssOf, groupColour } from './colours';
import { $, button, figure, h } from './dom';
import type { Picture } from './glb';
import { input, say, state } from './state';

const textOptions = ['max_edge', 'max_area', 'min_angle', 'max_volume', 'radius_edge', 'min_edge', 'symmetry_tolerance', 'sector'];
const choiceOptions = ['order', 'repair'];
const switchOptions = ['ignore_markers', 'keep_boundary', 'delaunay'];

function numberOr(text: string): unknown {
  const value = Number(text.replace(',', '.'));
  return Number.isFinite(value) ? value : text;
}

/** What the form says, but for what is left at its default. */
export function options(): Options {
  const given: Options = {};
  const fold = input('fold').value.trim();
  if (fold && fold !== 'auto') given.fold = numberOr(fold);
  for (const name of textOptions) {
    const text = input(name).value.trim();
    if (text && !input(name).closest('[hidden]')) given[name] = numberOr(text);
  }
  for (const name of choiceOptions) {
    const choice = $<HTMLSelectElement>(name).value;
    if (choice) given[name] = numberOr(choice);
  }
  for (const name of switchOptions) {
    if (input(name).checked && !input(name).closest('[hidden]')) given[name] = true;
  }
  const sizes = [...state.sizes].filter(([, size]) => size).map(([marker, size]) => `marker:${marker}=${size}`);
  if (sizes.length > 0 && state.inspection?.dimension === 2) given.sizes = sizes.join(',');
  return given;
}

export function setOptions(given: Options): void {
  const text = (value: unknown): string => (value === undefined || value === null ? '' : String(value));
  input('fold').value = given.fold === 'auto' ? '' : text(given.fold);
  for (const name of textOptions) input(name).value = text(given[name]);
  for (const name of choiceOptions) {
    const select = $<HTMLSelectElement>(name);
    const value = text(given[name]);
    select.value = [...select.options].some((option) => option.value === value) ? value : '';
  }
  for (const name of switchOptions) input(name).checked = given[name] === true;
  state.sizes.clear();
  for (const part of text(given.sizes).split(',')) {
    const found = /^ *marker[: ](-?\d+)=(.+)$/.exec(part);
    if (found) state.sizes.set(Number(found[1]), found[2]!);
  }
}

/** Options that an inspection looks at. */
export function inspectionOptions(): Options {
  const all = options();
  const chosen: Options = {};
  for (const name of ['fold', 'ignore_markers', 'repair', 'symmetry_tolerance', 'sector']) {
    if (all[name] !== undefined) chosen[name] = all[name];
  }
  return chosen;
}

export function showGroups(picture: Picture): void {
  const named = picture.groups.filter((group) => group.name !== 'at fault' && group.name !== 'boundary_0');
  const planar = state.inspection?.dimension === 2;
  $('groups-box').hidden = named.length === 0;
  $('groups').replaceChildren(...named.map((group, number) => {
    const marker = Number(/^boundary_(-?\d+)$/.exec(group.name)?.[1] ?? NaN);
    const name = group.name.replace('_', ' ');
    const swatch = h('span', { class: 'swatch' });
    swatch.style.background = cssOf(groupColour(number + 1));
    const size = h('input', { type: 'text', inputmode: 'decimal', placeholder: 'edges up to', 'aria-label': `Longest edge on ${name}`, value: state.sizes.get(marker) ?? '' }) as HTMLInputElement;
    size.addEventListener('input', () => { state.sizes.set(marker, size.value.trim()); estimate(); });
    return h('div', { class: 'group-row' }, swatch, h('span', {}, name), planar && Number.isFinite(marker) ? size : null);
  }));
}

const presets: Record<string, number | null> = { coarse: null, normal: 24, fine: 60 };

export function showPresets(): void {
  $('presets').replaceChildren(...Object.keys(presets).map((name) => button(name, () => applyPreset(name), { 'data-preset': name })));
  markPreset();
}

function presetEdge(name: string): string {
  const parts = presets[name];
  return parts && state.inspection ? Number((state.inspection.diameter / parts).toPrecision(2)).toString() : '';
}

function markPreset(): void {
  const free = input('max_area').value === '' && input('max_volume').value === '';
  for (const element of document.querySelectorAll<HTMLElement>('[data-preset]')) {
    const chosen = free && presetEdge(element.dataset.preset!) === input('max_edge').value.trim();
    element.setAttribute('aria-pressed', String(chosen));
  }
}

export function applyPreset(name: string): void {
  for (const id of ['max_area', 'max_volume']) input(id).value = '';
  input('max_edge').value = presetEdge(name);
  estimate();
  say(`${name} elements`);
}

/** Elements of a cell, as well as sizes alone tell. */
export function estimate(): void {
  const found = state.inspection;
  const place = $('estimate');
  markPreset();
  place.textContent = '';
  if (!found) return;
  const edge = Number(input('max_edge').value) || Infinity;
  const fold = Number(input('fold').value) || found.fold || 1;
  let count = 0;
  if (found.dimension === 2 && found.area) {
    // Triangles come out at about half of what the bounds allow.
    const largest = Math.min(0.433 * edge * edge * 0.62, (Number(input('max_area').value) || Infinity) * 0.6);
    count = found.area / fold / largest;
  } else if (found.volume) {
    const largest = Math.min(0.118 * edge ** 3 * 0.42, (Number(input('max_volume').value) || Infinity) * 0.42);
    count = found.volume / fold / largest;
  }
  if (count < 1) {
    place.textContent = 'As few elements as the shape allows.';
  } else {
    const round = Number(count.toPrecision(count < 100 ? 1 : 2));
    place.textContent = `About ${figure(round)} elements, or more where the shape is fine.`;
  }
}
