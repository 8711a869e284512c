// Calls of the service. A key is asked for once, when the service asks for one, and kept for the session.

export interface Warning {
  code: string;
  detail: string;
  mend: string;
  fold?: number;
  tolerance?: number;
}

interface FoldCandidate {
  fold: number;
  error: number;
  accepted: boolean;
  worst: [number, number, number] | null;
}

export interface Inspection {
  type: 'pslg' | 'plc' | 'surface';
  dimension: 2 | 3;
  fold: number;
  axis: { origin: number[]; direction: number[] };
  symmetry_error: number;
  area?: number;
  volume?: number | null;
  diameter: number;
  bounding_box: { min: number[]; max: number[] };
  vertices: number;
  segments?: number;
  facets?: number;
  triangles?: number;
  folds: FoldCandidate[];
  warnings: Warning[];
  problem?: string | null;
}

export interface Problem {
  code: string;
  detail: string;
  title?: string;
  status?: number;
}

export interface Statistics {
  cell: {
    elements: number; nodes: number; symmetry_nodes: number; symmetry_facets: number;
    area?: number; volume?: number; min_angle_deg: number; max_angle_deg: number;
    max_radius_edge: number; min_dihedral_deg: number | null; max_dihedral_deg: number | null;
  };
  full: { elements: number; nodes: number };
  symmetry: { fold: number; axis: { origin: number[]; direction: number[] }; error: number };
  exempt: { reason: string; elements: number }[];
  warnings: Warning[];
  timings_ms: Record<string, number>;
  peak_memory_bytes: number;
}

export type Options = Record<string, unknown>;

export interface Job {
  id: string;
  state: 'queued' | 'running' | 'succeeded' | 'failed' | 'cancelled';
  created_at: string;
  finished_at: string | null;
  progress: { fraction: number; phase: string; elements: number; quality: number };
  model: { format: string; name: string | null; bytes: number };
  options: Options;
  error?: Problem;
  warnings?: Warning[];
  statistics?: Statistics | null;
}

export class ProblemError extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail);
  }
}

const keyName = 'symcell-key';
let askForKey: () => Promise<string | null> = async () => null;

/** Who is asked for a key when the service wants one; once, for all calls that wait for it. */
export function onKeyWanted(ask: () => Promise<string | null>): void {
  let asked: Promise<string | null> | null = null;
  askForKey = () => {
    asked ??= ask().finally(() => { asked = null; });
    return asked;
  };
}

export async function call(path: string, init: RequestInit = {}): Promise<Response> {
  for (;;) {
    const headers = new Headers(init.headers);
    const key = sessionStorage.getItem(keyName);
    if (key) headers.set('Authorization', `Bearer ${key}`);
    let response: Response;
    try {
      response = await fetch(path, { ...init, headers });
    } catch (error) {
      if (init.signal?.aborted) throw error;
      throw new ProblemError({ code: 'unreachable', detail: 'The service does not answer. Is it running?' });
    }
    if (response.ok) return response;
    if (response.status === 401) {
      // Another call may have been given one meanwhile.
      if (sessionStorage.getItem(keyName) !== key) continue;
      sessionStorage.removeItem(keyName);
      const given = await askForKey();
      if (given) {
        sessionStorage.setItem(keyName, given);
        continue;
      }
    }
    const text = await response.text();
    let problem: Problem = { code: 'unknown', detail: text || response.statusText, status: response.status };
    try {
      problem = JSON.parse(text);
    } catch {
      // Not of the service: a proxy's own words are shown as they are.
    }
    throw new ProblemError(problem);
  }
}

function formOf(file: File, options: Options): FormData {
  const form = new FormData();
  form.append('model', file, file.name);
  form.append('options', JSON.stringify(options));
  return form;
}

export async function inspect(file: File, options: Options, signal: AbortSignal): Promise<ArrayBuffer> {
  const response = await call('/v1/inspect/form', {
    method: 'POST', body: formOf(file, options), signal, headers: { Accept: 'model/gltf-binary' },
  });
  return response.arrayBuffer();
}

export async function submit(file: File, options: Options): Promise<Job> {
  const response = await call('/v1/jobs/form', { method: 'POST', body: formOf(file, options) });
  return response.json();
}

export async function getJob(id: string): Promise<Job> {
  return (await call(`/v1/jobs/${id}`)).json();
}

export async function cancelJob(id: string): Promise<void> {
  await call(`/v1/jobs/${id}/cancel`, { method: 'POST' });
}

export async function deleteJob(id: string): Promise<void> {
  await call(`/v1/jobs/${id}`, { method: 'DELETE' });
}

export async function listJobs(cursor?: string): Promise<{ jobs: Job[]; next_cursor: string | null }> {
  const from = cursor ? `&cursor=${encodeURIComponent(cursor)}` : '';
  return (await call(`/v1/jobs?limit=24${from}`)).json();
}

export async function getCell(id: string): Promise<string> {
  return (await call(`/v1/jobs/${id}/cell?format=json&packed=true`)).text();
}

export async function getSurface(id: string): Promise<ArrayBuffer> {
  return (await call(`/v1/jobs/${id}/surface`, { headers: { Accept: 'model/gltf-binary' } })).arrayBuffer();
}

export async function getModel(id: string): Promise<Blob> {
  return (await call(`/v1/jobs/${id}/model`)).blob();
}

export function isFinished(job: Job): boolean {
  return job.state !== 'queued' && job.state !== 'running';
}
