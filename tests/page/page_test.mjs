// The pages as people use them, in headless Chromium. test_page.py starts the service and names it in SYMCELL_URL;
// downloads go to SYMCELL_DOWNLOADS, for other programs to open, pictures to SYMCELL_PICTURES if it is set.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';

import { chromium } from 'playwright-core';

const url = process.env.SYMCELL_URL;
const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const gear = await readFile(process.env.SYMCELL_GEAR);
const patience = 180_000;
let browser;

before(async () => {
  browser = await chromium.launch({
    executablePath: process.env.SYMCELL_CHROMIUM,
    // Root in a container has no sandbox; pictures are drawn without a graphics card.
    // A container's /dev/shm may be smaller than what a large mesh takes.
    args: ['--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
});
after(() => browser?.close());

/** A page whose console stays silent and that asks nobody but the service. */
async function open(path = '/', options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce', ...options });
  page.setDefaultTimeout(patience);
  page.faults = [];
  // The browser tells of every answer above 399; those are the page's business.
  page.on('console', (message) => {
    if (message.type() === 'error' && !message.text().startsWith('Failed to load resource')) page.faults.push(message.text());
  });
  page.on('pageerror', (error) => page.faults.push(error.message));
  page.on('request', (request) => {
    if (!request.url().startsWith(url) && !/^(data|blob):/.test(request.url())) page.faults.push(`asked ${request.url()}`);
  });
  await page.goto(url + path);
  return page;
}

async function close(page) {
  assert.deepEqual(page.faults, []);
  await page.close();
}

async function picture(page, name) {
  if (process.env.SYMCELL_PICTURES) await page.screenshot({ path: `${process.env.SYMCELL_PICTURES}/${name}.png` });
}

async function assertAccessible(page, what) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, {
    runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'], resultTypes: ['violations'] }));
  assert.deepEqual(violations.map((v) => `${what}: ${v.id}: ${v.nodes.map((n) => n.html).slice(0, 3)}`), []);
}

async function drop(page, bytes, name) {
  const transfer = await page.evaluateHandle(([data, fileName]) => {
    const held = new DataTransfer();
    held.items.add(new File([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))], fileName));
    return held;
  }, [Buffer.from(bytes).toString('base64'), name]);
  for (const type of ['dragenter', 'dragover', 'drop']) await page.dispatchEvent('#picture', type, { dataTransfer: transfer });
}

async function example(page, name) {
  await page.getByRole('button', { name, exact: true }).click();
  await page.locator('#found strong').waitFor();
}

async function meshed(page) {
  await page.getByRole('button', { name: 'Mesh it' }).click();
  await page.locator('#results').waitFor({ state: 'visible' });
}

/**
 * Follows the link, and keeps what it downloads. Chromium drops, without a word, what a page lets download beyond ten
 * files within a second of its own clock: few are asked for a second, and one that does not come is asked for again.
 */
async function fetched(page, link, file) {
  const tries = 4;
  for (let i = 1; ; ++i) {
    await page.waitForTimeout(200);
    try {
      const [download] = await Promise.all([
        page.waitForEvent('download', { timeout: patience / tries }), page.getByRole('link', { name: link, exact: true }).click()]);
      await download.saveAs(file);
      return;
    } catch (error) {
      if (i === tries) throw error;
      console.log(`${link}: asked for again after: ${error.message}`);
    }
  }
}

/** The job, once it has ended. */
async function ended(service, job) {
  while (['queued', 'running'].includes(job.state)) {
    job = await (await fetch(`${service}/v1/jobs/${job.id}`, { headers: { Prefer: 'wait=30' } })).json();
  }
  return job;
}

/** Share of the view's small picture that is not its background. */
function shownShare(page) {
  return page.evaluate(async () => {
    await window.symcell.viewer.settled();
    const image = new Image();
    image.src = window.symcell.viewer.thumbnail();
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    let shown = 0;
    for (let i = 3; i < pixels.length; i += 4) shown += pixels[i] > 128 ? 1 : 0;
    return shown / (pixels.length / 4);
  });
}

test('a part that is dropped is seen, meshed, unfolded and fetched', async () => {
  const page = await open();
  await picture(page, 'empty');
  await assertAccessible(page, 'empty page');
  await drop(page, gear, 'gear.stl');
  await page.locator('#found').getByText('17-fold').waitFor();
  assert.ok(await shownShare(page) > 0.15);
  await picture(page, 'model');
  await assertAccessible(page, 'model');
  await page.locator('#max_volume').fill('10');
  await meshed(page);
  assert.match(await page.locator('#figures').innerText(), /× 17/);
  const one = await shownShare(page);
  await picture(page, 'cell');
  await assertAccessible(page, 'mesh');

  await page.getByRole('button', { name: 'Full' }).click();
  assert.equal(await page.locator('#copies-out').innerText(), '17');
  await picture(page, 'full');
  assert.ok(await shownShare(page) > one, 'the full part fills more of the view');
  await page.getByRole('button', { name: 'Cell', exact: true }).click();
  await page.locator('#colour').selectOption('quality');
  await page.locator('#clip').fill('50');
  await picture(page, 'cut');
  await page.locator('#histogram button:not(:disabled)').first().click();
  await page.getByRole('button', { name: 'Show all elements' }).click();
  await page.locator('#worst button').first().click();
  await picture(page, 'worst');

  for (const format of ['vtu', 'msh', 'inp', 'glb', 'stl', 'json']) {
    for (const part of ['cell', 'full']) {
      await fetched(page, `${part} as ${format}`, `${process.env.SYMCELL_DOWNLOADS}/${part}.${format}`);
    }
  }
  for (const by of ['Python', 'symcell', 'curl']) await page.getByRole('button', { name: by, exact: true }).click();
  assert.match(await page.locator('#commands').innerText(), /'http.*max_volume=10'/);

  await page.getByRole('button', { name: 'Jobs' }).click();
  await page.locator('#job-list img').first().waitFor();
  await picture(page, 'jobs');
  await assertAccessible(page, 'jobs');
  await page.getByRole('button', { name: 'Open gear.stl' }).first().click();
  await page.locator('#results').waitFor({ state: 'visible' });
  await close(page);
});

test('what is wrong with a file is said, and a button mends it', async () => {
  const page = await open();
  await drop(page, 'no model at all', 'notes.txt');
  await page.locator('.problem').waitFor();
  // Three triangles less: holes that nothing but a repair closes.
  const open_ = Buffer.from(gear);
  const count = open_.readUInt32LE(80) - 3;
  open_.writeUInt32LE(count, 80);
  await drop(page, open_.subarray(0, 84 + 50 * count), 'open.stl');
  await page.locator('.problem').getByRole('button', { name: 'Repair it' }).waitFor();
  await page.locator('#legend').getByText('at fault').waitFor();
  await picture(page, 'problem');
  await assertAccessible(page, 'problem');
  await page.getByRole('button', { name: 'Repair it' }).click();
  await page.locator('#found').getByText('17-fold').waitFor();
  await page.locator('.problem').waitFor({ state: 'detached' });
  await meshed(page);
  await close(page);
});

test('another fold is taken, and a job is cancelled', async () => {
  const page = await open('/', { colorScheme: 'dark' });
  await example(page, 'Flange');
  assert.match(await page.locator('#found').innerText(), /8-fold/);
  await page.locator('#ladder').getByRole('button', { name: '4' }).click();
  await page.locator('#found').getByText('4-fold').waitFor();
  await meshed(page);
  assert.match(await page.locator('#figures').innerText(), /× 4/);
  await picture(page, 'dark');
  await assertAccessible(page, 'dark');

  await page.locator('#max_edge').fill('0.002');
  await page.getByRole('button', { name: 'Mesh it' }).click();
  await page.locator('#bar').waitFor({ state: 'visible' });
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.locator('#status').getByText('Cancelled.').waitFor({ state: 'attached' });
  assert.ok(await page.getByRole('button', { name: 'Mesh it' }).isEnabled());
  await close(page);
});

test('all is reached by the keyboard alone', async () => {
  const page = await open();
  const focused = () => page.evaluate(() => document.activeElement?.id || document.activeElement?.textContent?.trim());
  const tabTo = async (wanted) => {
    for (let i = 0; i < 80; ++i) {
      await page.keyboard.press('Tab');
      if (await focused() === wanted) return;
    }
    assert.fail(`Tab never came to ${wanted}`);
  };
  await tabTo('Hex nut');
  await page.keyboard.press('Enter');
  await page.locator('#found strong').waitFor();
  await tabTo('mesh');
  await page.keyboard.press('Enter');
  await page.locator('#results').waitFor({ state: 'visible' });
  await tabTo('canvas');
  const frames = () => page.locator('#canvas').getAttribute('data-frames').then(Number);
  const seen = await frames();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('+');
  await page.waitForFunction((n) => Number(document.getElementById('canvas').dataset.frames) > n, seen);
  await tabTo('see-full');
  await page.keyboard.press('Space');
  assert.equal(await page.locator('#copies-out').innerText(), '6');
  await close(page);
});

test('nothing is cut off on a screen of 320 pixels', async () => {
  const page = await open('/', { viewport: { width: 320, height: 640 } });
  await example(page, 'Motor');
  await meshed(page);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 320);
  await picture(page, 'narrow');
  await assertAccessible(page, 'narrow');
  await close(page);
});

test('a cell of a million triangles is seen', async () => {
  // Meshed as fast as can be: it is the picture that is asked for.
  const form = new FormData();
  form.append('model', new Blob([await readFile(process.env.SYMCELL_FLANGE)]), 'flange.json');
  form.append('options', JSON.stringify({ max_area: 0.0012, min_angle: 20, plain: true }));
  const job = await ended(url, await (await fetch(`${url}/v1/jobs/form`, { method: 'POST', body: form })).json());
  assert.equal(job.state, 'succeeded');
  const page = await open(`/#job=${job.id}`);
  await page.locator('#results').waitFor({ state: 'visible' });
  const elements = await page.evaluate(() => window.symcell.state.cell.elementCount);
  const perSecond = await page.evaluate(async () => {
    await window.symcell.viewer.settled();
    return window.symcell.viewer.measure(5);
  });
  console.log(`${elements} triangles, ${perSecond.toFixed(1)} frames a second without a graphics card`);
  assert.ok(elements > 900_000, `${elements}`);
  assert.ok(await shownShare(page) > 0.1);
  await close(page);
});

test('the description is read, and calls are tried', async () => {
  const page = await open('/docs');
  await page.locator('#createJob summary').first().click();
  await picture(page, 'docs');
  await assertAccessible(page, 'docs');
  const box = page.locator('#createJob');
  assert.match(await box.locator('.try pre').first().innerText(), new RegExp(`'${url}/v1/jobs'`));
  await box.getByRole('button', { name: 'Send' }).click();
  await box.getByText('202').last().waitFor();
  const names = await page.locator('.operation summary code').allInnerTexts();
  assert.ok(names.includes('/v1/jobs/{id}/surface'));
  await close(page);
});

test('a key is asked for once, and kept for the tab', async () => {
  const page = await browser.newPage({ reducedMotion: 'reduce' });
  page.setDefaultTimeout(patience);
  await page.goto(process.env.SYMCELL_LOCKED_URL);
  await page.getByRole('button', { name: 'Hex nut' }).click();
  const text = page.getByLabel('Key', { exact: true });
  for (const key of ['not a key', process.env.SYMCELL_KEY_TEXT]) {
    await text.waitFor();
    await assertAccessible(page, 'key');
    await text.fill(key);
    await page.getByRole('button', { name: 'Go on' }).click();
    await page.waitForFunction(() => !document.getElementById('key').open || document.getElementById('key-text').value === '');
  }
  await page.locator('#found strong').waitFor();
  await meshed(page);
  const file = `${process.env.SYMCELL_DOWNLOADS}/locked.vtu`;
  await fetched(page, 'cell as vtu', file);
  assert.match(await readFile(file, 'latin1'), /^<\?xml/);
  await page.reload();
  await page.locator('#results').waitFor({ state: 'visible' });
  await page.close();
});

test('a page of another origin that is allowed sends models and reads answers', async () => {
  const other = createServer((_, answer) => answer.writeHead(200, { 'Content-Type': 'text/html' }).end('<p>another</p>'));
  await new Promise((listening) => other.listen(0, '127.0.0.1', listening));
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${other.address().port}/`);
  const job = await page.evaluate(async ([service, data]) => {
    const form = new FormData();
    form.append('model', new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]), 'gear.stl');
    const answer = await fetch(`${service}/v1/jobs/form`, { method: 'POST', body: form });
    return { ...(await answer.json()), location: answer.headers.get('Location') };
  }, [process.env.SYMCELL_SHARED_URL, gear.toString('base64')]);
  assert.equal((await ended(process.env.SYMCELL_SHARED_URL, job)).state, 'succeeded', JSON.stringify(job));
  assert.equal(job.location, `/v1/jobs/${job.id}`);
  await page.close();
  other.close();
});
