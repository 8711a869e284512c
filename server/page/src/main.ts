// The page at /: from a dropped file to a mesh that can be looked at and fetched.
import flange from '../../../docs/examples/flange.json?url';
import gear from '../../../docs/examples/gear.stl?url';
import hexnut from '../../../docs/examples/hexnut.json?url';
import motor from '../../../docs/examples/motor.json?url';
import swirl from '../../../docs/examples/swirl.json?url';

import {
  call, cancelJob, deleteJob, getCell, getJob, getModel, getSurface, Inspection, inspect, isFinished, Job, listJobs,
  onKeyWanted, Options, Problem, ProblemError, Statistics, submit, Warning,
} from './api';
import { Cell, kHigher, kLower } from './cell';
import { cssOf, groupColour, higherColour, innerColour, lowerColour, qualityColour, regionColour } from './colours';
import { commandLine, curlLines, pythonLines } from './commands';
import { $, button, figure, h } from './dom';
import { Picture, readPicture } from './glb';
import { readPackedMesh } from './packed';
import { Legend, Viewer } from './viewer';

const examples: [string, string, string][] = [
  ['Gear', gear, 'gear.stl'], ['Flange', flange, 'flange.json'], ['Hex nut', hexnut, 'hexnut.json'],
  ['Motor', motor, 'motor.json'], ['Swirl', swirl, 'swirl.json'],
];
const textOptions = ['max_edge', 'max_area', 'min_angle', 'max_volume', 'radius_edge', 'min_edge', 'symmetry_tolerance', 'sector'];
const choiceOptions = ['order', 'repair'];
const switchOptions = ['ignore_markers', 'keep_boundary', 'delaunay'];

interface State {
  file: File | null;
  inspection: Inspection | null;
  job: Job | null;
  cell: Cell | null;
  modelLegend: Legend[];
  running: string | null;
  sizes: Map<number, string>;
}
const state: State = {
  file: null, inspection: null, job: null, cell: null, modelLegend: [], running: null, sizes: new Map(),
};

let viewer: Viewer | null = null;
try {
  viewer = new Viewer($<HTMLCanvasElement>('canvas'));
} catch {
  $('empty').replaceChildren(h('p', {}, 'This browser shows no WebGL: meshes are made and fetched, but not seen.'));
}

function say(text: string): void {
  $('status').textContent = text;
}

// --- Options ---

function input(id: string): HTMLInputElement {
  return $<HTMLInputElement>(id);
}

function numberOr(text: string): unknown {
  const value = Number(text.replace(',', '.'));
  return Number.isFinite(value) ? value : text;
}

/** What the form says, but for what is left at its default. */
function options(): Options {
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

function setOptions(given: Options): void {
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
function inspectionOptions(): Options {
  const all = options();
  const chosen: Options = {};
  for (const name of ['fold', 'ignore_markers', 'repair', 'symmetry_tolerance', 'sector']) {
    if (all[name] !== undefined) chosen[name] = all[name];
  }
  return chosen;
}

// --- A model comes ---

let looking: AbortController | null = null;

async function take(file: File, keepOptions = false): Promise<void> {
  if (!keepOptions) setOptions({});
  state.file = file;
  state.inspection = null;
  state.job = null;
  state.cell = null;
  location.hash = '';
  $('results').hidden = true;
  $('model-name').hidden = false;
  $('model-name').textContent = file.name;
  say(`Looking at ${file.name}`);
  await look();
}

async function look(): Promise<void> {
  const file = state.file;
  if (!file) return;
  looking?.abort();
  looking = new AbortController();
  showProblem(null);
  $('found').textContent = 'Looking…';
  $('notes').replaceChildren();
  $('symmetry').hidden = false;
  try {
    const picture = readPicture(await inspect(file, inspectionOptions(), looking.signal));
    showPicture(picture);
  } catch (error) {
    if ((error as Error).name === 'AbortError') return;
    $('symmetry').hidden = true;
    $('mesh-form').hidden = true;
    showProblem(problemOf(error));
  }
}

function problemOf(error: unknown): Problem {
  if (error instanceof ProblemError) return error.problem;
  return { code: 'page', detail: error instanceof Error ? error.message : String(error) };
}

function guessFrame(picture: Picture): { fold: number; axis: { origin: number[]; direction: number[] }; dimension: 2 | 3 } {
  const flat = picture.groups.every((group) => group.lines);
  return { fold: 1, axis: { origin: picture.offset, direction: [0, 0, 1] }, dimension: flat ? 2 : 3 };
}

function showPicture(picture: Picture): void {
  const { inspection, problem } = picture.extras;
  state.inspection = inspection ?? null;
  const frame = inspection ?? guessFrame(picture);
  state.modelLegend = viewer?.showPicture(picture, frame) ?? [];
  const missed = (inspection?.folds ?? []).filter((f) => !f.accepted && f.worst).map((f) => f.worst!);
  viewer?.showMarks(missed.slice(0, 3));
  $('empty').hidden = true;
  $('tools').hidden = false;
  see('model');
  for (const element of document.querySelectorAll<HTMLElement>('.planar')) element.hidden = frame.dimension === 3;
  for (const element of document.querySelectorAll<HTMLElement>('.solid')) element.hidden = frame.dimension === 2;
  $('mesh-form').hidden = false;
  if (problem) {
    $('found').textContent = 'No symmetry can be told as it is.';
    $('ladder').replaceChildren();
    showProblem(problem);
  } else if (inspection) {
    showInspection(inspection);
  }
  showGroups(picture);
  showPresets();
  estimate();
}

function showInspection(found: Inspection): void {
  const axis = found.axis.direction.map((c) => figure(c)).join(', ');
  const where = found.dimension === 3 && found.fold > 1 ? ` about the axis (${axis})` : '';
  $('found').replaceChildren(
    h('strong', {}, found.fold === 1 ? 'No symmetry' : `${found.fold}-fold`), where,
    h('br'), h('span', { class: 'dim small' }, sizeWords(found)));
  $('notes').replaceChildren(...found.warnings.map(note));
  if (found.problem) showProblem({ code: 'not_watertight', detail: found.problem });
  const fitting = found.folds.filter((f) => f.accepted && f.fold > 1).map((f) => f.fold);
  const shown = fitting.length > 10 ? [...fitting.slice(0, 3), ...fitting.slice(-7)] : fitting;
  $('ladder').replaceChildren(...shown.map((fold) =>
    button(String(fold), () => chooseFold(fold), { 'aria-pressed': String(fold === found.fold) })));
  say(found.fold === 1 ? 'No symmetry was found.' : `${found.fold}-fold symmetry.`);
  canvasLabel(`The model${found.fold > 1 ? `, ${found.fold} sectors` : ''}`);
}

function sizeWords(found: Inspection): string {
  const words = [`size ${figure(found.diameter)}`];
  if (found.triangles !== undefined) words.push(`${figure(found.triangles)} triangles`);
  if (found.segments !== undefined) words.push(`${figure(found.segments)} segments`);
  if (found.facets !== undefined) words.push(`${figure(found.facets)} facets`);
  if (found.fold > 1) words.push(found.symmetry_error < 1e-12 ? 'exact' : `off by ${figure(found.symmetry_error, 2)} of it`);
  return words.join(' · ');
}

function chooseFold(fold: number | string): void {
  input('fold').value = String(fold);
  void look();
}

// --- What is wrong, and what mends it ---

interface Mend { text: string; act: () => void }

function mendOptions(text: string, change: () => void): Mend {
  return { text, act: () => { change(); void look(); } };
}

function mendsOf(warning: Warning | Problem): Mend[] {
  const set = (name: string, value: string) => (): void => { $<HTMLInputElement>(name).value = value; };
  const check = (name: string) => (): void => { input(name).checked = true; };
  const mends: Mend[] = [];
  const code = warning.code;
  if (code === 'near_symmetry' && 'fold' in warning && warning.fold) {
    mends.push(mendOptions(`Take fold ${warning.fold}`, () => {
      input('symmetry_tolerance').value = String(warning.tolerance);
      input('fold').value = String(warning.fold);
    }));
  }
  if (code === 'markers_break_symmetry') mends.push(mendOptions('Leave groups out of it', check('ignore_markers')));
  if (code === 'fold_not_largest') mends.push(mendOptions('Take the largest', set('fold', 'max')));
  if (['not_watertight', 'self_intersection', 'overlapping_segments', 'duplicate_vertices', 'degenerate_facet'].includes(code)) {
    const repair = $<HTMLSelectElement>('repair').value;
    if (repair !== 'all' && repair !== 'wrap') mends.push(mendOptions('Repair it', set('repair', 'all')));
    if (repair !== 'wrap' && state.inspection?.dimension !== 2) mends.push(mendOptions('Wrap it', set('repair', 'wrap')));
  }
  if (code === 'not_symmetric' || code === 'bad_fold') {
    mends.push(mendOptions('Find the fold', set('fold', '')), mendOptions('Mesh without symmetry', set('fold', '1')));
  }
  if (code === 'ambiguous_symmetry') {
    for (const fold of ['4', '6', '12']) mends.push(mendOptions(`Fold ${fold}`, set('fold', fold)));
  }
  if (code === 'element_limit' || code === 'memory_limit' || code === 'time_limit') {
    mends.push({ text: 'Take larger elements', act: () => { applyPreset('coarse'); showProblem(null); } });
  }
  return mends;
}

function mendButtons(mends: Mend[]): HTMLElement | null {
  if (mends.length === 0) return null;
  return h('div', { class: 'mend' }, ...mends.map((mend) => button(mend.text, mend.act)));
}

function note(warning: Warning): HTMLElement {
  return h('div', { class: 'note' }, h('p', {}, capital(warning.detail), '.'),
           warning.mend ? h('p', { class: 'dim' }, capital(warning.mend), '.') : null, mendButtons(mendsOf(warning)));
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

const mostCharacters = 220;

/** The beginning of what may list dozens of places, and whether that is not all. */
function shortened(text: string): [string, boolean] {
  if (text.length <= mostCharacters) return [text, false];
  const colon = text.indexOf(': ');
  if (colon > 20 && colon < mostCharacters) {
    const list = text.indexOf('; ', colon);
    if (list > 0 && list < mostCharacters) return [`${text.slice(0, list)}, and more …`, true];
  }
  return [`${text.slice(0, text.lastIndexOf(' ', mostCharacters))} …`, true];
}

function showProblem(problem: Problem | null): void {
  if (!problem) {
    $('problem').replaceChildren();
    return;
  }
  const [first, rest] = shortened(problem.detail);
  $('problem').replaceChildren(h('div', { class: 'problem' }, h('h2', {}, problem.title ?? 'This cannot be meshed yet'),
    h('p', {}, capital(first), /[.…]$/.test(first) ? '' : '.'), mendButtons(mendsOf(problem)),
    rest ? h('details', {}, h('summary', {}, 'All of it'), h('p', {}, capital(problem.detail))) : null));
  $('problem').scrollIntoView({ block: 'nearest' });
}

// --- Groups ---

function showGroups(picture: Picture): void {
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

// --- Sizes ---

const presets: Record<string, number | null> = { coarse: null, normal: 24, fine: 60 };

function showPresets(): void {
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

function applyPreset(name: string): void {
  for (const id of ['max_area', 'max_volume']) input(id).value = '';
  input('max_edge').value = presetEdge(name);
  estimate();
  say(`${name} elements`);
}

/** Elements of a cell, as well as sizes alone tell. */
function estimate(): void {
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

// --- Meshing ---

async function meshIt(): Promise<void> {
  if (!state.file || state.running) return;
  showProblem(null);
  try {
    const job = await submit(state.file, options());
    state.running = job.id;
    location.hash = `job=${job.id}`;
    await follow(job);
  } catch (error) {
    showProblem(problemOf(error));
  } finally {
    state.running = null;
    setBusy(false);
  }
}

function setBusy(busy: boolean): void {
  $('mesh').toggleAttribute('disabled', busy);
  $('cancel').hidden = !busy;
  $('progress').hidden = !busy;
}

async function follow(job: Job): Promise<void> {
  setBusy(true);
  let wait = 60;
  while (!isFinished(job)) {
    showProgress(job);
    await new Promise((resolve) => setTimeout(resolve, wait));
    wait = Math.min(wait * 1.4, 400);
    job = await getJob(job.id);
  }
  setBusy(false);
  state.job = job;
  if (job.state === 'succeeded') await showJob(job);
  else if (job.state === 'failed') showProblem(job.error!);
  else {
    say('Cancelled.');
    $('phase').textContent = '';
    showProblem(null);
  }
}

const phases: Record<string, string> = {
  parse: 'Reading', symmetry: 'Finding the symmetry', initial: 'First mesh', refine: 'Refining', improve: 'Improving',
  cell: 'Cutting the cell', write: 'Writing', done: 'Done',
};

function showProgress(job: Job): void {
  $<HTMLProgressElement>('bar').value = job.progress.fraction;
  const words = job.state === 'queued' ? 'Waiting' : phases[job.progress.phase] ?? job.progress.phase;
  const elements = job.progress.elements > 0 ? `, ${figure(job.progress.elements)} elements` : '';
  $('phase').textContent = words + elements;
}

async function showJob(job: Job): Promise<void> {
  say('The mesh is done; fetching it.');
  const cell = new Cell(readPackedMesh(await getCell(job.id)));
  state.cell = cell;
  viewer?.showCell(cell);
  $('empty').hidden = true;
  $('tools').hidden = false;
  const copies = input('copies');
  copies.max = String(viewer?.mostCopies ?? 1);
  copies.value = '1';
  $('copies-out').textContent = '1';
  input('clip').value = '100';
  for (const element of document.querySelectorAll<HTMLElement>('.clip')) element.hidden = cell.mesh.dimension === 2;
  see('cell');
  showResults(job, job.statistics!, cell);
  say(`${figure(cell.elementCount)} elements in the cell.`);
  requestAnimationFrame(() => keepThumbnail(job.id));
}

// --- Seeing ---

function see(what: 'model' | 'cell' | 'full'): void {
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

function unfoldTo(count: number): void {
  cancelAnimationFrame(unfolding);
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

function setCopies(count: number): void {
  input('copies').value = String(count);
  $('copies-out').textContent = String(Math.round(count));
  viewer?.setCopies(count);
  if (state.cell) {
    $('see-cell').setAttribute('aria-pressed', String(count === 1));
    $('see-full').setAttribute('aria-pressed', String(count >= Number(input('copies').max) && count > 1));
    showLegend();
  }
}

function canvasLabel(text: string): void {
  $('canvas').setAttribute('aria-label', text);
}

function showLegend(): void {
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

// --- Results ---

function showResults(job: Job, statistics: Statistics, cell: Cell): void {
  const solid = cell.mesh.dimension === 3;
  const degrees = (value: number | null | undefined): string => (value == null ? '–' : `${figure(value)}°`);
  const rows: [string, string, string?][] = [
    ['Elements', figure(statistics.cell.elements), figure(statistics.full.elements)],
    ['Nodes', figure(statistics.cell.nodes), figure(statistics.full.nodes)],
    ['On the bound', figure(statistics.cell.symmetry_facets), ''],
    [solid ? 'Volume' : 'Area', figure((solid ? statistics.cell.volume : statistics.cell.area) ?? 0, 4), figure(((solid ? statistics.cell.volume : statistics.cell.area) ?? 0) * statistics.symmetry.fold, 4)],
    [solid ? 'Dihedral angles' : 'Angles', solid ? `${degrees(statistics.cell.min_dihedral_deg)} – ${degrees(statistics.cell.max_dihedral_deg)}` : `${degrees(statistics.cell.min_angle_deg)} – ${degrees(statistics.cell.max_angle_deg)}`, ''],
    ['Radius / edge', figure(statistics.cell.max_radius_edge), ''],
    ['Time', `${figure(statistics.timings_ms.total! / 1000, 2)} s`, ''],
  ];
  $('figures').replaceChildren(h('table', {}, h('thead', {}, h('tr', {}, h('th', {}, h('span', { class: 'visually-hidden' }, 'Figure')), h('th', { scope: 'col' }, 'cell'), h('th', { scope: 'col' }, `× ${statistics.symmetry.fold}`))),
    h('tbody', {}, ...rows.map(([name, one, all]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, one), h('td', {}, all ?? ''))))));
  $('warnings').replaceChildren(...statistics.warnings.map(note));
  showHistogram(cell);
  $('worst').replaceChildren(...cell.worst.map((element) =>
    button(`${figure(cell.quality[element]!)}°`, () => {
      see('cell');
      setCopies(1);
      select(new Set([element]), `Element ${element}`);
      viewer?.flyTo(element);
    }, { 'aria-label': `Fly to element ${element}, ${figure(cell.quality[element]!)} degrees` })));
  showDownloads(job, solid);
  showCommands('curl');
  $('results').hidden = false;
}

function select(elements: Set<number> | null, words: string, pressed: HTMLElement | null = null): void {
  viewer?.select(elements);
  $('clear-selection').hidden = elements === null;
  say(words);
  for (const bar of document.querySelectorAll('#histogram button')) bar.setAttribute('aria-pressed', String(bar === pressed));
}

function showHistogram(cell: Cell): void {
  const { counts, binWidth, label } = cell.histogram;
  const most = Math.max(...counts, 1);
  const last = counts.length - 1;
  $('quality-title').textContent = label;
  $('histogram').replaceChildren(...counts.map((count, i) => {
    const stem = h('span', { class: 'stem' });
    // A few among a million are still to be seen.
    stem.style.height = count === 0 ? '0' : `${Math.max(3, 82 * (count / most))}%`;
    stem.style.background = cssOf(qualityColour((i + 0.5) / last));
    const from = i * binWidth;
    const bar = button('', () => {
      const on = bar.getAttribute('aria-pressed') === 'true';
      if (on) {
        select(null, 'All elements');
        return;
      }
      const chosen = new Set<number>();
      for (let e = 0; e < cell.elementCount; ++e) if (cell.bin(e) === i) chosen.add(e);
      see('cell');
      setCopies(1);
      select(chosen, `${count} elements from ${from} to ${from + binWidth} degrees`, bar);
    }, { 'aria-pressed': 'false', 'aria-label': `${from} to ${from + binWidth} degrees: ${count} elements`, title: `${from}–${from + binWidth}°: ${figure(count)}`, disabled: count === 0 });
    bar.append(stem, h('span', { class: 'tick' }, i % 2 === 0 ? String(from) : ''));
    return bar;
  }));
}

const formats: [string, string, 0 | 2 | 3][] = [
  ['vtu', 'ParaView', 0], ['msh', 'Gmsh', 0], ['inp', 'CalculiX, Abaqus', 0], ['bdf', 'Nastran', 0], ['cdb', 'ANSYS', 0],
  ['msh2', 'Gmsh 2', 0], ['json', 'programs', 0], ['vtp', 'boundary', 0], ['glb', 'viewers', 0], ['svg', 'picture', 2], ['stl', 'surface', 3],
];

function showDownloads(job: Job, solid: boolean): void {
  const rows: Node[] = [];
  for (const [format, purpose, dimension] of formats) {
    if (dimension !== 0 && dimension !== (solid ? 3 : 2)) continue;
    rows.push(h('span', {}, h('strong', {}, format), ' ', h('span', { class: 'for' }, purpose)));
    for (const part of ['cell', 'full']) {
      const path = `/v1/jobs/${job.id}/${part}?format=${format}`;
      rows.push(h('a', { href: path, download: `${part}.${format}`, 'aria-label': `${part} as ${format}`, onclick: (event: Event) => fetchWithKey(event, path, `${part}.${format}`) }, part));
    }
  }
  $('downloads').replaceChildren(h('div', { class: 'downloads' }, ...rows),
    h('p', { class: 'small' }, fileLink(`/v1/jobs/${job.id}/statistics`, 'statistics.json', 'statistics'), ' · ',
      fileLink(`/v1/jobs/${job.id}/model`, job.model.name ?? 'model', 'model')));
}

function fileLink(path: string, name: string, text: string): HTMLElement {
  return h('a', { href: path, download: name, onclick: (event: Event) => fetchWithKey(event, path, name) }, text);
}

// A link carries no key.
function fetchWithKey(event: Event, path: string, name: string): void {
  if (!sessionStorage.getItem('symcell-key')) return;
  event.preventDefault();
  void call(path).then((response) => response.blob()).then((blob) => {
    const link = h('a', { href: URL.createObjectURL(blob), download: name }) as HTMLAnchorElement;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  }).catch((error) => showProblem(problemOf(error)));
}

function showCommands(by: 'curl' | 'python' | 'command'): void {
  for (const name of ['curl', 'python', 'command']) $(`by-${name}`).setAttribute('aria-pressed', String(name === by));
  const file = state.file?.name ?? state.job?.model.name ?? 'model';
  const given = options();
  $('commands').textContent = by === 'curl' ? curlLines(file, given) : by === 'python' ? pythonLines(file, given) : commandLine(file, given);
}

// --- Jobs ---

const thumbnailPrefix = 'symcell-picture-';
const mostThumbnails = 60;

function keepThumbnail(id: string): void {
  if (!viewer) return;
  try {
    const kept = Object.keys(localStorage).filter((name) => name.startsWith(thumbnailPrefix)).sort();
    // Ids begin with their time.
    for (const old of kept.slice(0, Math.max(0, kept.length - mostThumbnails))) localStorage.removeItem(old);
    localStorage.setItem(thumbnailPrefix + id, viewer.thumbnail());
  } catch {
    // No room, or no storage in this browser: lists go without pictures.
  }
}

let nextJobs: string | null = null;

async function showJobs(more = false): Promise<void> {
  if (!$<HTMLDialogElement>('jobs').open) $<HTMLDialogElement>('jobs').showModal();
  try {
    const page = await listJobs(more ? nextJobs ?? undefined : undefined);
    nextJobs = page.next_cursor;
    $('more-jobs').hidden = nextJobs === null;
    const items = page.jobs.map(jobItem);
    if (more) $('job-list').append(...items);
    else $('job-list').replaceChildren(...(items.length > 0 ? items : [h('li', {}, 'None yet.')]));
  } catch (error) {
    $('job-list').replaceChildren(h('li', {}, problemOf(error).detail));
  }
}

function jobItem(job: Job): HTMLElement {
  const picture = localStorage.getItem(thumbnailPrefix + job.id);
  const name = job.model.name ?? job.model.format;
  const words = job.state === 'succeeded' ? `${figure(job.progress.elements)} elements` : job.state === 'failed' ? job.error?.title ?? 'failed' : job.state;
  const item: HTMLElement = h('li', {},
    picture ? h('img', { src: picture, alt: '' }) : h('span', { class: 'blank' }),
    h('div', {}, h('p', { class: 'name' }, name), h('p', { class: 'dim small' }, words, ' · ', new Date(job.created_at).toLocaleString())),
    button('Open', () => void openJob(job.id), { 'aria-label': `Open ${name}` }),
    button('Delete', () => void deleteJob(job.id).then(() => { localStorage.removeItem(thumbnailPrefix + job.id); item.remove(); }), { 'aria-label': `Delete ${name}` }));
  return item;
}

async function openJob(id: string): Promise<void> {
  $<HTMLDialogElement>('jobs').close();
  showProblem(null);
  try {
    const [job, surface, model] = await Promise.all([getJob(id), getSurface(id), getModel(id)]);
    state.file = new File([model], job.model.name ?? `model.${job.model.format}`);
    state.job = job;
    state.cell = null;
    $('model-name').hidden = false;
    $('model-name').textContent = state.file.name;
    const asked: Options = { ...job.options };
    // What the form leaves out is what a new job would be given anyway.
    for (const [name, value] of [['min_angle', 30], ['radius_edge', 1.414], ['repair', 'safe'], ['order', 1], ['symmetry_tolerance', 1e-6], ['symmetry_tolerance', 1e-3]] as const) {
      if (asked[name] === value) delete asked[name];
    }
    setOptions(asked);
    $('symmetry').hidden = false;
    showPicture(readPicture(surface));
    location.hash = `job=${id}`;
    if (!isFinished(job)) {
      state.running = id;
      await follow(job);
      state.running = null;
    } else if (job.state === 'succeeded') {
      await showJob(job);
    } else if (job.error) {
      showProblem(job.error);
    }
  } catch (error) {
    showProblem(problemOf(error));
  }
}

// --- Wiring ---

function wire(): void {
  $('examples').append(...examples.map(([name, url, file]) => button(name, () => {
    void fetch(url).then((response) => response.blob()).then((blob) => take(new File([blob], file)));
  })));
  const chooser = input('file');
  chooser.addEventListener('change', () => { if (chooser.files?.[0]) void take(chooser.files[0]); });
  let inside = 0;
  addEventListener('dragenter', (event) => { event.preventDefault(); ++inside; $('dropping').hidden = false; });
  addEventListener('dragleave', () => { if (--inside <= 0) $('dropping').hidden = true; });
  addEventListener('dragover', (event) => event.preventDefault());
  addEventListener('drop', (event) => {
    event.preventDefault();
    inside = 0;
    $('dropping').hidden = true;
    const file = event.dataTransfer?.files[0];
    if (file) void take(file);
  });

  for (const name of ['fold', 'symmetry_tolerance', 'sector', 'repair', 'ignore_markers']) {
    $(name).addEventListener('change', () => void look());
  }
  $('mesh-form').addEventListener('input', estimate);
  $('mesh-form').addEventListener('submit', (event) => { event.preventDefault(); void meshIt(); });
  $('cancel').addEventListener('click', () => { if (state.running) void cancelJob(state.running).catch((error) => showProblem(problemOf(error))); });

  $('see-model').addEventListener('click', () => { see('model'); viewer?.reset(); });
  $('see-cell').addEventListener('click', () => { see('cell'); unfoldTo(1); });
  $('see-full').addEventListener('click', () => { see('full'); select(null, ''); unfoldTo(Number(input('copies').max)); });
  input('copies').addEventListener('input', () => { cancelAnimationFrame(unfolding); setCopies(Number(input('copies').value)); });
  input('copies').addEventListener('change', () => setCopies(Math.round(Number(input('copies').value))));
  const clip = (): void => { viewer?.setClip(Number($<HTMLSelectElement>('clip-axis').value), Number(input('clip').value) / 100); showLegend(); };
  input('clip').addEventListener('input', clip);
  $('clip-axis').addEventListener('change', clip);
  $('colour').addEventListener('change', () => { viewer?.setColouring($<HTMLSelectElement>('colour').value as 'groups'); showLegend(); });
  input('edges').addEventListener('change', () => viewer?.setEdges(input('edges').checked));
  $('fit').addEventListener('click', () => viewer?.reset());
  $('clear-selection').addEventListener('click', () => select(null, 'All elements'));

  $('canvas').addEventListener('keydown', (event) => {
    const act: Record<string, () => void> = {
      ArrowLeft: () => viewer?.turn(-10, 0), ArrowRight: () => viewer?.turn(10, 0),
      ArrowUp: () => viewer?.turn(0, 10), ArrowDown: () => viewer?.turn(0, -10),
      '+': () => viewer?.zoom(1.2), '=': () => viewer?.zoom(1.2), '-': () => viewer?.zoom(1 / 1.2), '0': () => viewer?.reset(),
    };
    const chosen = act[event.key];
    if (!chosen || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    chosen();
  });

  for (const by of ['curl', 'python', 'command'] as const) $(`by-${by}`).addEventListener('click', () => showCommands(by));
  $('copy').addEventListener('click', () => void navigator.clipboard.writeText($('commands').textContent ?? '').then(() => say('Copied.')));
  $('show-jobs').addEventListener('click', () => void showJobs());
  $('close-jobs').addEventListener('click', () => $<HTMLDialogElement>('jobs').close());
  $('more-jobs').addEventListener('click', () => void showJobs(true));
  onKeyWanted(() => new Promise((resolve) => {
    const dialog = $<HTMLDialogElement>('key');
    input('key-text').value = '';
    dialog.showModal();
    dialog.addEventListener('close', () => resolve(dialog.returnValue === 'ok' ? input('key-text').value.trim() || null : null), { once: true });
  }));
  drawFan();
  const asked = /^#job=(\w+)$/.exec(location.hash);
  if (asked) void openJob(asked[1]!);
}

// What the page is about, before there is anything to see: a ring of triangles, one cell in colour.
function drawFan(): void {
  const place = $('fan') as unknown as SVGElement;
  const sectors = 12, radii = [34, 62, 90, 112];
  for (let s = sectors - 1; s >= 0; --s) {
    for (let ring = 0; ring + 1 < radii.length; ++ring) {
      const at = (r: number, k: number): string => {
        const angle = (2 * Math.PI * (k + r * 0.5)) / sectors;
        return `${(120 + radii[r]! * Math.cos(angle)).toFixed(1)},${(120 - radii[r]! * Math.sin(angle)).toFixed(1)}`;
      };
      for (const corners of [[at(ring, s), at(ring + 1, s), at(ring, s + 1)], [at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)]]) {
        const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
        path.setAttribute('d', `M${corners.join(' ')}Z`);
        if (s === 0) path.setAttribute('class', 'one');
        place.append(path);
      }
    }
  }
}

wire();
// For measuring, and for tests that wait for a picture.
Object.assign(window, { symcell: { viewer, state, kLower, kHigher } });
