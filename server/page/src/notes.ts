// What is wrong with a model or told of a mesh, and buttons that mend it.
import { type Problem, ProblemError, type Warning } from './api';
import { $, button, h } from './dom';
import { applyPreset } from './form';
import { input, state } from './state';

let lookAgain = (): void => undefined;

/** What is to be done when options have changed to mend something. */
export function onMended(act: () => void): void {
  lookAgain = act;
}

export function problemOf(error: unknown): Problem {
  if (error instanceof ProblemError) return error.problem;
  return { code: 'page', detail: error instanceof Error ? error.message : String(error) };
}

interface Mend { text: string; act: () => void }

function mendOptions(text: string, change: () => void): Mend {
  return { text, act: () => { change(); lookAgain(); } };
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

export function note(warning: Warning): HTMLElement {
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

export function showProblem(problem: Problem | null): void {
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
