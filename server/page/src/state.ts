// What the page shows, and where: shared by its parts.
import type { Inspection, Job } from './api';
import type { Cell } from './cell';
import { $, h } from './dom';
import { type Legend, Viewer } from './viewer';

interface State {
  file: File | null;
  inspection: Inspection | null;
  job: Job | null;
  cell: Cell | null;
  modelLegend: Legend[];
  running: string | null;
  sizes: Map<number, string>;
}
export const state: State = {
  file: null, inspection: null, job: null, cell: null, modelLegend: [], running: null, sizes: new Map(),
};

export let viewer: Viewer | null = null;
try {
  viewer = new Viewer($<HTMLCanvasElement>('canvas'));
} catch {
  $('empty').replaceChildren(h('p', {}, 'This browser shows no WebGL: meshes are made and fetched, but not seen.'));
}

export function say(text: string): void {
  $('status').textContent = text;
}

export function input(id: string): HTMLInputElement {
  return $<HTMLInputElement>(id);
}

export function canvasLabel(text: string): void {
  $('canvas').setAttribute('aria-label', text);
}
