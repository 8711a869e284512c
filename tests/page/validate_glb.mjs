// Khronos' validator on GLB files: prints a JSON object of the faults a file, errors and warnings.
import { readFile } from 'node:fs/promises';

import { validateBytes } from 'gltf-validator';

const found = {};
for (const path of process.argv.slice(2)) {
  const report = await validateBytes(new Uint8Array(await readFile(path)));
  found[path] = report.issues.messages
    .filter((message) => message.severity < 2)
    .map((message) => `${message.code} ${message.pointer}: ${message.message}`);
}
console.log(JSON.stringify(found));
