// What is seen: model, cell or copies of it, and the legend of its colours.
import { cssOf, groupColour, higherColour, innerColour, lowerColour, qualityColour, regionColour } from './colours';
import { $, h } from './dom';
import { canvasLabel, input, state, viewer } from './state';
import type { Legend } from './viewer';

export function see(what: 'model' | 'cell' | 'full'): void {
  const ready = state.cell !== null;
  for (const name of ['model', 'cell', 'full'] as const) {
    $(`see-${name}`).setAttribute('aria-pressed', String(name === what));
    if (name !== 'model') $(`see-${name}`).toggleAttribute('disabled', !ready);
  }
  const mesh = what !== 'model';
  for (const element of document.querySelectorAll<HTMLElement>('.needs-mesh')) {
    element.hidden = !mesh || (element.classList.contains('clip') && state.cell?.mesh.dimension === 2);
  }
  viewer?.view(mesh ? 'mesh' : 'model');
  showLegend();
  if (mesh && state.cell) {
    const fold = state.cell.mesh.fold;
    canvasLabel(what === 'full' ? `The full mesh, ${fold} copies of the cell` : `One cell of ${fold}, ${state.cell.elementCount} elements`);
  }
}

let unfolding = 0;

export function stopUnfolding(): void {
  cancelAnimationFrame(unfolding);
}

export function unfoldTo(count: number): void {
  stopUnfolding();
  const from = Number(input('copies').value);
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const length = still ? 0 : Math.min(1800, 500 + 60 * Math.abs(count - from));
  const begin = performance.now();
  const step = (): void => {
    const t = length === 0 ? 1 : Math.min((performance.now() - begin) / length, 1);
    setCopies(t === 1 ? count : from + (count - from) * t * t * (3 - 2 * t));
    if (t < 1) unfolding = requestAnimationFrame(step);
    else viewer?.reset();
  };
  step();
}

export function setCopies(count: number): void {
  input('copies').value = String(count);
  $('copies-out').textContent = String(Math.round(count));
  viewer?.setCopies(count);
  if (state.cell) {
    $('see-cell').setAttribute('aria-pressed', String(count === 1));
    $('see-full').setAttribute('aria-pressed', String(count >= Number(input('copies').max) && count > 1));
    showLegend();
  }
}

export function showLegend(): void {
  const entries: Legend[] = [];
  const cell = state.cell;
  const mesh = $('see-model').getAttribute('aria-pressed') === 'false';
  const colouring = $<HTMLSelectElement>('colour').value;
  if (!mesh || !cell) {
    entries.push(...state.modelLegend);
  } else if (colouring === 'quality') {
    for (const share of [0, 0.5, 1]) {
      const degrees = Math.round(share * (cell.mesh.dimension === 3 ? 70 : 60));
      entries.push({ name: `${degrees}°`, css: cssOf(qualityColour(share)) });
    }
  } else if (colouring === 'regions') {
    cell.regions.forEach((region, i) => entries.push({ name: `region ${region}`, css: cssOf(regionColour(cell.regions.length > 1 ? i + 1 : 0)) }));
  } else {
    if (cell.mesh.lowerFacets.length > 0 && $('see-full').getAttribute('aria-pressed') === 'false') {
      entries.push({ name: 'lower bound', css: cssOf(lowerColour) }, { name: 'higher bound', css: cssOf(higherColour) });
    }
    cell.markers.forEach((marker, i) => {
      if (marker !== 0) entries.push({ name: cell.markerName(marker), css: cssOf(groupColour(i + (cell.markers[0] === 0 ? 0 : 1))) });
    });
    if (cell.mesh.dimension === 3 && cell.regions.length === 1 && Number(input('clip').value) < 100) entries.push({ name: 'inside', css: cssOf(innerColour) });
  }
  $('legend').replaceChildren(...entries.slice(0, 12).map((entry) => {
    const swatch = h('span', { class: 'swatch' });
    swatch.style.background = entry.css;
    return h('li', {}, swatch, entry.name);
  }));
}
