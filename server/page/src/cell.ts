// What of a cell is drawn: faces between elements, their groups, and the quality of every element.
import type { PackedMesh } from './packed';

/** Kinds of a face besides the numbers of boundary groups, which count from 0. */
export const kInner = -1;
export const kLower = -2;
export const kHigher = -3;

interface Histogram {
  label: string;
  unit: string;
  binWidth: number;
  counts: number[];
}

export class Cell {
  /** Faces of a solid, or the triangles of a planar mesh: three corners each. */
  readonly faces: Uint32Array;
  /** The element on either side; -1: none. */
  readonly inside: Int32Array;
  readonly outside: Int32Array;
  /** kInner, kLower, kHigher or the number of a boundary group. */
  readonly kind: Int8Array;
  readonly markers: number[];
  readonly regions: number[];
  readonly elementCount: number;
  /** Degrees: the smallest angle of a triangle, the smallest dihedral angle of a tetrahedron. */
  readonly quality: Float32Array;
  readonly histogram: Histogram;
  readonly worst: number[];

  constructor(readonly mesh: PackedMesh) {
    this.elementCount = mesh.elements.length / mesh.nodesPerElement;
    this.markers = [...new Set(mesh.boundaryMarkers)].sort((a, b) => a - b);
    this.regions = [...new Set(mesh.regions)].sort((a, b) => a - b);
    if (mesh.dimension === 3) {
      const found = facesOf(mesh, this.elementCount);
      this.faces = found.faces;
      this.inside = found.inside;
      this.outside = found.outside;
      this.kind = this.kinds(found);
    } else {
      this.faces = cornersOf(mesh, 3);
      this.inside = Int32Array.from({ length: this.elementCount }, (_, i) => i);
      this.outside = new Int32Array(this.elementCount).fill(-1);
      this.kind = new Int8Array(this.elementCount).fill(kInner);
    }
    this.quality = mesh.dimension === 3 ? dihedralAngles(mesh, this.elementCount)
                                        : triangleAngles(mesh, this.elementCount);
    this.histogram = this.countQuality();
    this.worst = this.findWorst(12);
  }

  markerName(marker: number): string {
    return this.mesh.markerNames[String(marker)] ?? (marker === 0 ? 'unnamed' : `boundary ${marker}`);
  }

  bin(element: number): number {
    return Math.min(Math.floor(this.quality[element]! / this.histogram.binWidth), this.histogram.counts.length - 1);
  }

  /** Middle of an element. */
  centre(element: number): [number, number, number] {
    const corners = this.mesh.dimension + 1;
    const middle: [number, number, number] = [0, 0, 0];
    for (let i = 0; i < corners; ++i) {
      const node = this.mesh.elements[element * this.mesh.nodesPerElement + i]!;
      for (let c = 0; c < 3; ++c) middle[c]! += this.mesh.nodes[3 * node + c]! / corners;
    }
    return middle;
  }

  private kinds(found: FoundFaces): Int8Array {
    const kind = new Int8Array(found.inside.length).fill(kInner);
    const mark = (facets: ArrayLike<number>, i: number, value: number): void => {
      const at = i * this.mesh.nodesPerFacet;
      const face = found.find(facets[at]!, facets[at + 1]!, facets[at + 2]!);
      if (face >= 0) kind[face] = value;
    };
    const number = new Map(this.markers.map((marker, i) => [marker, i]));
    for (let i = 0; i < this.mesh.boundaryMarkers.length; ++i) {
      mark(this.mesh.boundary, i, Math.min(number.get(this.mesh.boundaryMarkers[i]!)!, 100));
    }
    const bounds = this.mesh.lowerFacets.length / this.mesh.nodesPerFacet;
    for (let i = 0; i < bounds; ++i) {
      mark(this.mesh.lowerFacets, i, kLower);
      mark(this.mesh.higherFacets, i, kHigher);
    }
    return kind;
  }

  private countQuality(): Histogram {
    const solid = this.mesh.dimension === 3;
    // Up to the regular element's 70.5 and 60 degrees, in bars that a finger meets.
    const binWidth = solid ? 8 : 6;
    const counts = new Array<number>(solid ? 9 : 10).fill(0);
    for (const value of this.quality) ++counts[Math.min(Math.floor(value / binWidth), counts.length - 1)]!;
    return { label: solid ? 'Smallest dihedral angle' : 'Smallest angle', unit: '°', binWidth, counts };
  }

  private findWorst(count: number): number[] {
    const worst: number[] = [];
    for (let e = 0; e < this.elementCount; ++e) {
      if (worst.length === count && this.quality[e]! >= this.quality[worst[count - 1]!]!) continue;
      let at = worst.length;
      while (at > 0 && this.quality[worst[at - 1]!]! > this.quality[e]!) --at;
      worst.splice(at, 0, e);
      if (worst.length > count) worst.pop();
    }
    return worst;
  }
}

function cornersOf(mesh: PackedMesh, corners: number): Uint32Array {
  const count = mesh.elements.length / mesh.nodesPerElement;
  const result = new Uint32Array(count * corners);
  for (let e = 0; e < count; ++e) {
    for (let i = 0; i < corners; ++i) result[e * corners + i] = mesh.elements[e * mesh.nodesPerElement + i]!;
  }
  return result;
}

interface FoundFaces {
  faces: Uint32Array;
  inside: Int32Array;
  outside: Int32Array;
  find(a: number, b: number, c: number): number;
}

// Face i lies opposite corner i and looks outwards.
const tetrahedronFaces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] as const;

function facesOf(mesh: PackedMesh, elements: number): FoundFaces {
  const { elements: corners, nodesPerElement } = mesh;
  // A face belongs to two tetrahedra or to one: between two and four a tetrahedron.
  let faces = new Uint32Array(12 * elements);
  const inside = new Int32Array(4 * elements);
  const outside = new Int32Array(4 * elements).fill(-1);
  let bits = 4;
  while (1 << bits < 8 * elements) ++bits;
  const mask = (1 << bits) - 1;
  const table = new Int32Array(1 << bits).fill(-1);
  let count = 0;
  const slotOf = (a: number, b: number, c: number): number => {
    const least = Math.min(a, b, c), most = Math.max(a, b, c), middle = a + b + c - least - most;
    let slot = (Math.imul(least, 0x9e3779b1) ^ Math.imul(middle, 0x85ebca6b) ^ Math.imul(most, 0xc2b2ae35)) >>> 0;
    slot = (slot ^ (slot >>> 15)) & mask;
    for (; table[slot]! >= 0; slot = (slot + 1) & mask) {
      const at = 3 * table[slot]!;
      const p = faces[at]!, q = faces[at + 1]!, r = faces[at + 2]!;
      if (Math.min(p, q, r) === least && Math.max(p, q, r) === most && p + q + r === least + middle + most) break;
    }
    return slot;
  };
  for (let e = 0; e < elements; ++e) {
    const at = e * nodesPerElement;
    for (const [i, j, k] of tetrahedronFaces) {
      const a = corners[at + i]!, b = corners[at + j]!, c = corners[at + k]!;
      const slot = slotOf(a, b, c);
      if (table[slot]! >= 0) {
        outside[table[slot]!] = e;
        continue;
      }
      table[slot] = count;
      faces[3 * count] = a;
      faces[3 * count + 1] = b;
      faces[3 * count + 2] = c;
      inside[count++] = e;
    }
  }
  faces = faces.slice(0, 3 * count);
  return {
    faces, inside: inside.slice(0, count), outside: outside.slice(0, count),
    find: (a, b, c) => table[slotOf(a, b, c)]!,
  };
}

const degrees = 180 / Math.PI;

function triangleAngles(mesh: PackedMesh, elements: number): Float32Array {
  const { nodes: p, elements: corners, nodesPerElement } = mesh;
  const result = new Float32Array(elements);
  for (let e = 0; e < elements; ++e) {
    const at = e * nodesPerElement;
    let least = Math.PI;
    for (let i = 0; i < 3; ++i) {
      const a = 3 * corners[at + i]!, b = 3 * corners[at + ((i + 1) % 3)]!, c = 3 * corners[at + ((i + 2) % 3)]!;
      const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!;
      least = Math.min(least, Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy));
    }
    result[e] = least * degrees;
  }
  return result;
}

function dihedralAngles(mesh: PackedMesh, elements: number): Float32Array {
  const { nodes: p, elements: corners, nodesPerElement } = mesh;
  const result = new Float32Array(elements);
  const normals = new Float64Array(12);
  for (let e = 0; e < elements; ++e) {
    const at = e * nodesPerElement;
    for (let f = 0; f < 4; ++f) {
      const [i, j, k] = tetrahedronFaces[f]!;
      const a = 3 * corners[at + i]!, b = 3 * corners[at + j]!, c = 3 * corners[at + k]!;
      const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, uz = p[b + 2]! - p[a + 2]!;
      const vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!, vz = p[c + 2]! - p[a + 2]!;
      const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
      const size = Math.hypot(nx, ny, nz) || 1;
      normals[3 * f] = nx / size;
      normals[3 * f + 1] = ny / size;
      normals[3 * f + 2] = nz / size;
    }
    // The smallest angle has the largest cosine of minus the normals' product.
    let largest = -1;
    for (let f = 0; f < 4; ++f) {
      for (let g = f + 1; g < 4; ++g) {
        const cosine = -(normals[3 * f]! * normals[3 * g]! + normals[3 * f + 1]! * normals[3 * g + 1]! +
                         normals[3 * f + 2]! * normals[3 * g + 2]!);
        if (cosine > largest) largest = cosine;
      }
    }
    result[e] = Math.acos(Math.min(1, largest)) * degrees;
  }
  return result;
}
