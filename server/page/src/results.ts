// What a finished job shows: figures, the histogram, files and the lines that do the same elsewhere.
import { call, type Job, type Statistics } from './api';
import type { Cell } from './cell';
import { cssOf, qualityColour } from './colours';
import { commandLine, curlLines, pythonLines } from './commands';
import { $, button, figure, h } from './dom';
import { options } from './form';
import { note, problemOf, showProblem } from './notes';
import { see, setCopies } from './seeing';
import { say, state, viewer } from './state';

export function showResults(job: Job, statistics: Statistics, cell: Cell): void {
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

export function select(elements: Set<number> | null, words: string, pressed: HTMLElement | null = null): void {
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

export const formats: [string, string, 0 | 2 | 3][] = [
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

export function showCommands(by: 'curl' | 'python' | 'command'): void {
  for (const name of ['curl', 'python', 'command']) $(`by-${name}`).setAttribute('aria-pressed', String(name === by));
  const file = state.file?.name ?? state.job?.model.name ?? 'model';
  const given = options();
  $('commands').textContent = by === 'curl' ? curlLines(file, given) : by === 'python' ? pythonLines(file, given) : commandLine(file, given);
}
