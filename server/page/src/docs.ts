// /docs: openapi.yaml as a page, with calls that can be tried.
import { parse } from 'yaml';

import { call, onKeyWanted, ProblemError } from './api';
import { quoted } from './commands';
import { $, button, h } from './dom';

interface Schema {
  $ref?: string; type?: string | string[]; enum?: unknown[]; const?: unknown; oneOf?: Schema[]; items?: Schema;
  properties?: Record<string, Schema>; required?: string[]; description?: string; default?: unknown;
  minimum?: number; maximum?: number; exclusiveMinimum?: number; format?: string; pattern?: string; example?: unknown;
}
interface Parameter { $ref?: string; name: string; in: string; required?: boolean; description?: string; schema?: Schema; example?: unknown }
interface Media { schema?: Schema; example?: unknown; examples?: Record<string, { summary?: string; value?: unknown; $ref?: string }> }
interface Body { $ref?: string; description?: string; content: Record<string, Media> }
interface Operation {
  operationId: string; summary: string; description?: string; tags: string[]; parameters?: Parameter[];
  requestBody?: Body; responses: Record<string, Body & { headers?: Record<string, unknown> }>;
}
interface Description {
  info: { title: string; description: string; license: { name: string } };
  tags: { name: string; description: string }[];
  paths: Record<string, Record<string, unknown>>;
  components: Record<string, Record<string, unknown>>;
}

let description: Description;

function resolve<T extends { $ref?: string }>(node: T): T {
  let found: unknown = node;
  while ((found as { $ref?: string })?.$ref) {
    found = (found as { $ref: string }).$ref.slice(2).split('/').reduce((at: unknown, part) =>
      (at as Record<string, unknown>)[part], description);
  }
  return found as T;
}

const title: Record<string, string> = { jobs: 'Jobs', service: 'Service' };

async function start(): Promise<void> {
  onKeyWanted(async () => prompt('This service wants an API key.'));
  const text = await (await fetch('/openapi.yaml')).text();
  description = parse(text) as Description;
  const content = $('content');
  content.replaceChildren(intro());
  const contents = $('contents');
  contents.replaceChildren();
  for (const tag of description.tags) {
    const list = h('ul');
    const section = h('section', { 'aria-labelledby': `tag-${tag.name}` }, h('h2', { id: `tag-${tag.name}` }, title[tag.name] ?? tag.name));
    for (const [path, item] of Object.entries(description.paths)) {
      for (const method of ['get', 'post', 'put', 'delete']) {
        const operation = item[method] as Operation | undefined;
        if (!operation?.tags.includes(tag.name)) continue;
        const shared = (item.parameters as Parameter[] | undefined) ?? [];
        const parameters = [...shared, ...(operation.parameters ?? [])].map(resolve);
        section.append(operationBox(method, path, operation, parameters));
        list.append(h('li', {}, h('a', { href: `#${operation.operationId}` }, h('span', { class: `method ${method}` }, method), path.replace('/v1', ''))));
      }
    }
    contents.append(h('h2', {}, title[tag.name] ?? tag.name), list);
    content.append(section);
  }
  content.append(schemas());
  openTarget();
  addEventListener('hashchange', openTarget);
}

function openTarget(): void {
  const target = location.hash.length > 1 ? document.getElementById(location.hash.slice(1)) : null;
  if (!target) return;
  const box = target.closest('details') ?? target.querySelector('details');
  if (box) (box as HTMLDetailsElement).open = true;
  target.scrollIntoView();
}

function intro(): HTMLElement {
  return h('section', { class: 'intro' }, ...prose(description.info.description),
    h('p', {}, 'A first mesh:'), lines(`curl -s --data-binary @part.stl -H 'Content-Type: model/stl' -H 'Prefer: wait=60' \\\n  '${location.origin}/v1/jobs?max_volume=10'`),
    h('p', { class: 'dim' }, `Licence: ${description.info.license.name}. The same as a file: `, h('a', { href: '/openapi.yaml' }, 'openapi.yaml'), '; in short: ', h('a', { href: '/docs/plain' }, 'options and formats'), '.'));
}

/** Paragraphs, with `code` in backquotes. */
function prose(text: string): HTMLElement[] {
  return text.trim().split(/\n\n+/).map((paragraph) => h('p', {}, ...inline(paragraph)));
}

function inline(text: string): (Node | string)[] {
  return text.split(/(`[^`]+`)/).map((part) => (part.startsWith('`') ? h('code', {}, part.slice(1, -1)) : part));
}

function lines(text: string): HTMLElement {
  return h('pre', { tabindex: 0 }, h('code', {}, text));
}

function operationBox(method: string, path: string, operation: Operation, parameters: Parameter[]): HTMLElement {
  const body = operation.requestBody ? resolve(operation.requestBody) : null;
  const details = h('details', {}, h('summary', {}, h('span', { class: `method ${method}` }, method), h('code', {}, path), h('span', { class: 'summary' }, operation.summary)));
  let filled = false;
  details.addEventListener('toggle', () => {
    if (filled) return;
    filled = true;
    details.append(...(operation.description ? prose(operation.description) : []),
      ...(parameters.length > 0 ? [parameterTable(parameters)] : []),
      ...(body ? [bodyBox(body)] : []), responses(operation), tryBox(method, path, parameters, body));
  });
  return h('article', { id: operation.operationId, class: 'operation' }, details);
}

function parameterTable(parameters: Parameter[]): HTMLElement {
  return h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Parameters' }, h('table', {}, h('thead', {}, h('tr', {}, ...['parameter', 'in', 'type', 'meaning'].map((name) => h('th', { scope: 'col' }, name)))),
    h('tbody', {}, ...parameters.map((parameter) => h('tr', {}, h('th', { scope: 'row' }, h('code', {}, parameter.name), parameter.required ? ' *' : ''), h('td', {}, parameter.in), h('td', {}, typeWords(parameter.schema ?? {})),
      h('td', {}, ...inline([parameter.description ?? resolve(parameter.schema ?? {}).description ?? '', defaultWords(parameter.schema ?? {})].filter(Boolean).join(' '))))))));
}

function typeWords(given: Schema): string {
  const schema = resolve(given);
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.enum) return schema.enum.map(String).join(' | ');
  if (schema.oneOf) return schema.oneOf.map((one) => (one.$ref ? one.$ref.split('/').pop()! : typeWords(one))).join(' or ');
  const type = Array.isArray(schema.type) ? schema.type.join(' or ') : schema.type ?? 'any';
  if (type === 'array') return schema.items ? `list of ${schema.items.$ref ? schema.items.$ref.split('/').pop()! : typeWords(schema.items)}` : 'list';
  const bounds = [
    schema.exclusiveMinimum !== undefined ? `> ${schema.exclusiveMinimum}` : schema.minimum !== undefined ? `≥ ${schema.minimum}` : '',
    schema.maximum !== undefined ? `≤ ${schema.maximum}` : ''].filter(Boolean).join(', ');
  return [schema.format === 'binary' ? 'file' : type, bounds].filter(Boolean).join(' ');
}

function defaultWords(given: Schema): string {
  const value = resolve(given).default;
  return value === undefined ? '' : `Default \`${String(value)}\`.`;
}

function bodyBox(body: Body): HTMLElement {
  const types = Object.keys(body.content);
  return h('div', {}, h('h3', {}, 'Body'), ...(body.description ? prose(body.description) : []),
    h('p', {}, ...types.flatMap((type, i) => [i > 0 ? ', ' : '', h('code', {}, type), schemaLink(body.content[type]!.schema)])));
}

function schemaLink(schema: Schema | undefined): HTMLElement | string {
  if (!schema?.$ref) return '';
  const name = schema.$ref.split('/').pop()!;
  return h('span', {}, ': ', h('a', { href: `#schema-${name}` }, name));
}

function responses(operation: Operation): HTMLElement {
  return h('div', {}, h('h3', {}, 'Answers'), h('dl', { class: 'answers' }, ...Object.entries(operation.responses).flatMap(([status, given]) => {
    const response = resolve(given);
    const types = Object.entries(response.content ?? {});
    return [h('dt', {}, h('span', { class: `status s${status.charAt(0)}` }, status)), h('dd', {}, ...inline(response.description ?? ''), ' ', ...types.slice(0, 12).flatMap(([type, media], i) => [i > 0 ? ', ' : '', h('code', {}, type), schemaLink(media.schema)]))];
  })));
}

// --- Trying calls ---

function tryBox(method: string, path: string, parameters: Parameter[], body: Body | null): HTMLElement {
  const fields = new Map<Parameter, HTMLInputElement | HTMLSelectElement>();
  const id = `${method}${path}`.replace(/\W/g, '-');
  const rows = parameters.filter((parameter) => parameter.in !== 'header' || parameter.name === 'Prefer').map((parameter) => {
    const schema = resolve(parameter.schema ?? {});
    const field = (schema.enum
      ? h('select', { id: `${id}-${parameter.name}` }, h('option', { value: '' }, '–'), ...schema.enum.map((value) => h('option', {}, String(value))))
      : h('input', { id: `${id}-${parameter.name}`, type: 'text', autocomplete: 'off', placeholder: schema.default !== undefined ? String(schema.default) : '' })) as HTMLInputElement;
    fields.set(parameter, field);
    field.addEventListener('input', () => update());
    return h('div', { class: 'field' }, h('label', { for: field.id }, parameter.name), field);
  });
  const types = body ? Object.keys(body.content) : [];
  const json = types.includes('application/json');
  const example = json ? exampleOf(body!.content['application/json']!) : undefined;
  const text = json ? h('textarea', { id: `${id}-body`, rows: 9, spellcheck: 'false' }) as HTMLTextAreaElement : null;
  if (text) {
    text.value = example === undefined ? '' : JSON.stringify(example, null, 1);
    text.addEventListener('input', () => update());
  }
  const file = body && !json ? h('input', { id: `${id}-file`, type: 'file' }) as HTMLInputElement : null;
  file?.addEventListener('change', () => update());
  const command = h('code');
  const answer = h('div', { class: 'answer', role: 'status' });

  const address = (): string => {
    let filled = path;
    const query = new URLSearchParams();
    for (const [parameter, field] of fields) {
      if (parameter.in === 'path') filled = filled.replace(`{${parameter.name}}`, field.value ? encodeURIComponent(field.value) : parameter.name.toUpperCase());
      else if (parameter.in === 'query' && field.value) query.append(parameter.name, field.value);
    }
    return filled + (query.size > 0 ? `?${query}` : '');
  };
  const headers = (): [string, string][] => [...fields].filter(([parameter, field]) => parameter.in === 'header' && field.value).map(([parameter, field]) => [parameter.name, field.value]);
  const update = (): void => {
    const parts = ['curl -s'];
    if (method !== 'get' && !body) parts.push(`-X ${method.toUpperCase()}`);
    for (const [name, value] of headers()) parts.push(`-H ${quoted(`${name}: ${value}`)}`);
    if (text) parts.push(`-H 'Content-Type: application/json' -d ${quoted(compact(text.value))}`);
    const name = file?.files?.[0]?.name ?? 'part.stl';
    if (file && types.includes('multipart/form-data')) parts.push(`-F ${quoted(`model=@${name}`)} -F 'options={}'`);
    else if (file) parts.push(`--data-binary ${quoted(`@${name}`)} -H 'Content-Type: application/octet-stream'`);
    command.textContent = `${parts.join(' \\\n  ')} \\\n  ${quoted(location.origin + address())}`;
  };
  const send = async (): Promise<void> => {
    answer.textContent = 'Asking…';
    const init: RequestInit = { method: method.toUpperCase(), headers: Object.fromEntries(headers()) };
    if (text) {
      init.body = text.value;
      (init.headers as Record<string, string>)['Content-Type'] = 'application/json';
    } else if (file?.files?.[0]) {
      if (types.includes('multipart/form-data')) {
        const form = new FormData();
        form.append('model', file.files[0], file.files[0].name);
        init.body = form;
      } else {
        init.body = file.files[0];
        (init.headers as Record<string, string>)['Content-Type'] = 'application/octet-stream';
      }
    }
    try {
      const response = await call(address(), init);
      await showAnswer(answer, response);
    } catch (error) {
      const problem = error instanceof ProblemError ? error.problem : { detail: String(error) };
      answer.replaceChildren(h('p', {}, h('span', { class: 'status s4' }, String('status' in problem ? problem.status : 'error'))), lines(JSON.stringify(problem, null, 2)));
    }
  };
  update();
  return h('div', { class: 'try' }, h('h3', {}, 'Try it'), h('div', { class: 'fields' }, ...rows),
    text ? h('div', { class: 'field wide' }, h('label', { for: text.id }, 'Body'), text) : null,
    file ? h('div', { class: 'field' }, h('label', { for: file.id }, 'Model file'), file) : null,
    h('pre', { tabindex: 0 }, command),
    h('p', {}, button('Send', () => void send(), { class: 'primary' })), answer);
}

function compact(text: string): string {
  try {
    return JSON.stringify(JSON.parse(text));
  } catch {
    return text;
  }
}

function exampleOf(media: Media): unknown {
  if (media.example !== undefined) return media.example;
  const first = Object.values(media.examples ?? {})[0];
  return first ? (resolve(first as { $ref?: string }) as { value?: unknown }).value : undefined;
}

const mostShown = 20_000;

async function showAnswer(place: HTMLElement, response: Response): Promise<void> {
  const type = response.headers.get('Content-Type') ?? '';
  const status = h('p', {}, h('span', { class: 'status s2' }, String(response.status)), ' ', h('code', {}, type));
  if (/json|text|yaml|xml/.test(type) && !/event-stream/.test(type)) {
    const text = await response.text();
    let shown = text;
    if (/json/.test(type) && text.length < mostShown) shown = JSON.stringify(JSON.parse(text), null, 2);
    const cut = shown.length > mostShown ? `${shown.slice(0, mostShown)}\n… ${shown.length - mostShown} more characters` : shown;
    place.replaceChildren(status, lines(cut));
    const id = /json/.test(type) ? (JSON.parse(text) as { id?: string }).id : undefined;
    if (id) place.append(h('p', {}, h('a', { href: `/#job=${id}` }, 'See this job'), '.'));
    return;
  }
  const blob = await response.blob();
  place.replaceChildren(status, h('p', {}, h('a', { href: URL.createObjectURL(blob), download: 'answer' }, `Save ${blob.size} bytes`)));
}

// --- Schemas ---

function schemas(): HTMLElement {
  const section = h('section', { 'aria-labelledby': 'schemas' }, h('h2', { id: 'schemas' }, 'Schemas'));
  for (const [name, given] of Object.entries(description.components.schemas as Record<string, Schema>)) {
    const box = h('details', {}, h('summary', {}, h('code', {}, name), h('span', { class: 'summary' }, given.description?.split('\n')[0] ?? '')));
    if (given.description) box.append(...prose(given.description));
    if (given.properties) box.append(propertyTable(name, given));
    else box.append(h('p', {}, h('code', {}, typeWords(given))));
    section.append(h('article', { id: `schema-${name}`, class: 'operation' }, box));
  }
  return section;
}

function propertyTable(name: string, schema: Schema): HTMLElement {
  return h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': `Members of ${name}` }, h('table', {}, h('thead', {}, h('tr', {}, ...['name', 'type', 'meaning'].map((column) => h('th', { scope: 'col' }, column)))),
    h('tbody', {}, ...Object.entries(schema.properties!).map(([member, given]) => h('tr', {}, h('th', { scope: 'row' }, h('code', {}, member), schema.required?.includes(member) ? ' *' : ''),
      h('td', {}, given.$ref ? h('a', { href: `#schema-${given.$ref.split('/').pop()}` }, given.$ref.split('/').pop()!) : typeWords(given)),
      h('td', {}, ...inline([resolve(given).description ?? '', defaultWords(given)].filter(Boolean).join(' '))))))));
}

start().catch((error) => {
  $('content').replaceChildren(h('p', { role: 'alert' }, `The description could not be read: ${error}. `, h('a', { href: '/openapi.yaml' }, 'openapi.yaml')));
});
