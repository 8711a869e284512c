// Packed JSON (?format=json&packed=true) as typed arrays.

type Numbers = Float32Array | Float64Array | Uint8Array | Uint16Array | Uint32Array | Int32Array;

interface PackedArray {
  type: string;
  shape: number[];
  data?: string;
  value?: number;
}

export interface PackedMesh {
  dimension: 2 | 3;
  order: 1 | 2;
  fold: number;
  axis: { origin: number[]; direction: number[] };
  markerNames: Record<string, string>;
  /** Coordinates relative to the axis' origin, three a node. */
  nodes: Float32Array;
  elements: Numbers;
  nodesPerElement: number;
  regions: Numbers;
  boundary: Numbers;
  nodesPerFacet: number;
  boundaryMarkers: Numbers;
  lowerFacets: Numbers;
  higherFacets: Numbers;
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

function unpack(array: PackedArray): Numbers {
  const count = array.shape.reduce((product, extent) => product * extent, 1);
  if (array.data === undefined) return new Int32Array(count).fill(array.value ?? 0);
  const bytes = bytesOf(array.data);
  switch (array.type) {
    case 'float32': return new Float32Array(bytes);
    case 'float64': return new Float64Array(bytes);
    case 'uint8': return new Uint8Array(bytes);
    case 'uint16': return new Uint16Array(bytes);
    case 'int32': return new Int32Array(bytes);
    case 'uint32': return new Uint32Array(bytes);
    case 'uint24': {
      const parts = new Uint8Array(bytes);
      const values = new Uint32Array(count);
      for (let i = 0, at = 0; i < count; ++i, at += 3) {
        values[i] = parts[at]! | (parts[at + 1]! << 8) | (parts[at + 2]! << 16);
      }
      return values;
    }
    default: throw new Error(`an array of unknown type ${array.type}`);
  }
}

export function readPackedMesh(text: string): PackedMesh {
  const json = JSON.parse(text);
  const planar = unpack(json.nodes);
  let nodes = planar as Float32Array;
  if (json.dimension === 2) {
    nodes = new Float32Array((planar.length / 2) * 3);
    for (let i = 0; i < planar.length / 2; ++i) {
      nodes[3 * i] = planar[2 * i]!;
      nodes[3 * i + 1] = planar[2 * i + 1]!;
    }
  }
  return {
    dimension: json.dimension, order: json.order, fold: json.fold, axis: json.axis,
    markerNames: json.marker_names ?? {}, nodes,
    elements: unpack(json.elements), nodesPerElement: json.elements.shape[1],
    regions: unpack(json.regions),
    boundary: unpack(json.boundary), nodesPerFacet: json.boundary.shape[1],
    boundaryMarkers: unpack(json.boundary_markers),
    lowerFacets: unpack(json.lower_facets), higherFacets: unpack(json.higher_facets),
  };
}
