// Uploads a model by the generated clients, unedited; prints a JSON object of what came back.
// node use_clients.mjs FILE URL, after tsc has compiled this and the clients beside it.
import { readFile } from 'node:fs/promises';

import { client } from './hey/client.gen.js';
import * as hey from './hey/sdk.gen.js';
import * as orval from './orval/api.js';

const [file, url] = process.argv.slice(2) as [string, string];
const model = new File([new Uint8Array(await readFile(file))], 'gear.stl');
client.setConfig({ baseUrl: url });

async function heyElements(id: string): Promise<number> {
  const job = await hey.getJob({ path: { id }, throwOnError: true });
  return job.data.progress.elements;
}

const wait = { Prefer: 'wait=60' };
const elements: Record<string, number> = {};
const heyFile = await hey.createJobFromFile({
  body: model, query: { max_volume: 10 }, headers: wait, throwOnError: true,
});
elements['hey-api file'] = await heyElements(heyFile.data.id);
const heyForm = await hey.createJobFromForm({
  body: { model, options: { max_volume: 10 } }, headers: wait, throwOnError: true,
});
elements['hey-api form'] = await heyElements(heyForm.data.id);

const orvalFile = await orval.createJobFromFile(model, { max_volume: 10 }, { headers: wait });
if (orvalFile.status !== 201) throw new Error(JSON.stringify(orvalFile.data));
elements['orval file'] = orvalFile.data.progress.elements;
const orvalForm = await orval.createJobFromForm(
  { model, options: { max_volume: 10 } }, { headers: wait });
if (orvalForm.status !== 201) throw new Error(JSON.stringify(orvalForm.data));
elements['orval form'] = orvalForm.data.progress.elements;

console.log(JSON.stringify(elements));
