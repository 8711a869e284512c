// The page at /: from a dropped file to a mesh that can be looked at and fetched.
import flange from '../../../docs/examples/flange.json?url';
import gear from '../../../docs/examples/gear.stl?url';
import hexnut from '../../../docs/examples/hexnut.json?url';
import motor from '../../../docs/examples/motor.json?url';
import swirl from '../../../docs/examples/swirl.json?url';

import {
  cancelJob, getCell, getJob, getModel, getSurface, type Inspection, inspect, isFinished, type Job, onKeyWanted,
  type Options, submit,
} from './api';
import { Cell, kHigher, kLower } from './cell';
import { $, button, figure, h } from './dom';
import { drawFan } from './fan';
import { estimate, inspectionOptions, options, setOptions, showGroups, showPresets } from './form';
import { type Picture, readPicture } from './glb';
import { keepThumbnail, onOpen, showJobs } from './jobs';
import { note, onMended, problemOf, showProblem } from './notes';
import { readPackedMesh } from './packed';
import { select, showCommands, showResults } from './results';
import { see, setCopies, showLegend, stopUnfolding, unfoldTo } from './seeing';
import { canvasLabel, input, say, state, viewer } from './state';

const examples: [string, string, string][] = [
  ['Gear', gear, 'gear.stl'], ['Flange', flange, 'flange.json'], ['Hex nut', hexnut, 'hexnut.json'],
  ['Motor', motor, 'motor.json'], ['Swirl', swirl, 'swirl.json'],
];

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

// --- An earlier job ---

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
  onMended(() => void look());
  onOpen((id) => void openJob(id));
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
  input('copies').addEventListener('input', () => { stopUnfolding(); setCopies(Number(input('copies').value)); });
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

wire();
// For measuring, and for tests that wait for a picture.
Object.assign(window, { symcell: { viewer, state, kLower, kHigher } });
