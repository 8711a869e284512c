// The model's picture: as much of binary glTF as the service writes.

interface PictureGroup {
  name: string;
  colour: [number, number, number];
  lines: boolean;
  indices: Uint32Array;
}

export interface Picture {
  positions: Float32Array;
  /** What is to be added to every position. */
  offset: [number, number, number];
  groups: PictureGroup[];
  extras: { inspection?: import('./api').Inspection; problem?: { code: string; detail: string } };
}

export function readPicture(bytes: ArrayBuffer): Picture {
  const view = new DataView(bytes);
  if (view.getUint32(0, true) !== 0x46546c67) throw new Error('the answer is no GLB file');
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 20, length)));
  const start = 20 + length + 8;
  const place = (accessor: number): [number, number] => {
    const { bufferView, count } = json.accessors[accessor];
    return [start + json.bufferViews[bufferView].byteOffset, count];
  };
  const node = json.nodes.find((n: { mesh?: number }) => n.mesh !== undefined);
  const primitives = json.meshes[node.mesh].primitives;
  const [positionsAt, count] = place(primitives[0].attributes.POSITION);
  return {
    positions: new Float32Array(bytes.slice(positionsAt, positionsAt + 12 * count)),
    offset: node.translation ?? [0, 0, 0],
    groups: primitives.map((p: { indices: number; material: number; mode: number }) => {
      const [at, indices] = place(p.indices);
      const material = json.materials[p.material];
      return {
        name: material.name,
        colour: material.pbrMetallicRoughness.baseColorFactor.slice(0, 3),
        lines: p.mode === 1,
        indices: new Uint32Array(bytes.slice(at, at + 4 * indices)),
      };
    }),
    extras: json.scenes[0].extras ?? {},
  };
}
