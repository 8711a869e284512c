// The lines that do the same as the page, for a shell and for Python.
import type { Options } from './api';

/** For a shell, in single quotes. */
export function quoted(text: string): string {
  return `'${text.replaceAll("'", "'\\''")}'`;
}

function textOf(value: unknown): string {
  return Array.isArray(value) ? value.join(',') : String(value);
}

export function curlLines(file: string, options: Options): string {
  const query = new URLSearchParams(Object.entries(options).map(([name, value]) => [name, textOf(value)]));
  const address = `${location.origin}/v1/jobs/file${query.size > 0 ? `?${query}` : ''}`;
  const key = sessionStorage.getItem('symcell-key') ? ` \\\n  -H "Authorization: Bearer $SYMCELL_KEY"` : '';
  return [
    `curl -s --data-binary @${quoted(file)}${key} \\\n  -H 'Content-Type: application/octet-stream' -H 'Prefer: wait=60' \\\n  ${quoted(address)} > job.json`,
    `id=$(sed -n 's/^  "id": "\\(.*\\)",/\\1/p' job.json)`,
    `curl -s "${location.origin}/v1/jobs/$id/cell?format=vtu" -o cell.vtu`,
    `curl -s "${location.origin}/v1/jobs/$id/full?format=vtu" -o full.vtu`,
  ].join('\n');
}

export function commandLine(file: string, options: Options): string {
  const flags = Object.entries(options).map(([name, value]) => {
    const flag = `--${name.replaceAll('_', '-')}`;
    return value === true ? flag : `${flag} ${/^[\w.,:=+-]+$/.test(textOf(value)) ? textOf(value) : quoted(textOf(value))}`;
  });
  return ['symcell mesh', quoted(file), ...flags, '--cell cell.vtu --full full.vtu'].join(' \\\n  ');
}

function python(value: unknown): string {
  if (value === true) return 'True';
  if (value === false) return 'False';
  return JSON.stringify(value);
}

export function pythonLines(file: string, options: Options): string {
  const given = Object.entries(options).map(([name, value]) => `, ${name}=${python(value)}`).join('');
  return [
    'import symcell', '',
    `mesh = symcell.mesh(${JSON.stringify(file)}${given},`,
    `                    server=${JSON.stringify(location.origin)})`,
    'print(mesh.fold, len(mesh.cell.elements), mesh.statistics["cell"])',
    'mesh.save("cell.vtu")',
    'mesh.save("full.vtu", part="full")',
  ].join('\n');
}
