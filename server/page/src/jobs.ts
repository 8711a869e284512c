// The list of jobs, with pictures that this browser keeps.
import { deleteJob, type Job, listJobs } from './api';
import { $, button, figure, h } from './dom';
import { problemOf } from './notes';
import { viewer } from './state';

let openJob = (_id: string): void => undefined;

/** What opens a job of the list. */
export function onOpen(act: (id: string) => void): void {
  openJob = act;
}

const thumbnailPrefix = 'symcell-picture-';
const mostThumbnails = 60;

export function keepThumbnail(id: string): void {
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

export async function showJobs(more = false): Promise<void> {
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
    button('Open', () => openJob(job.id), { 'aria-label': `Open ${name}` }),
    button('Delete', () => void deleteJob(job.id).then(() => { localStorage.removeItem(thumbnailPrefix + job.id); item.remove(); }), { 'aria-label': `Delete ${name}` }));
  return item;
}
