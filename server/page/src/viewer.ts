// What is seen: the model as it came, or the mesh as one cell and as many turned copies of it as wanted.
// Draws when something changed, and not otherwise.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

import { Cell, kHigher, kInner, kLower } from './cell';
import {
  Colour, cssOf, faultColour, groupColour, higherColour, innerColour, lowerColour, qualityColour,
  regionColour, selectedColour,
} from './colours';
import type { Picture } from './glb';
import { makeSurfaceMaterial, noClip, SurfaceMaterial } from './shading';

type Colouring = 'groups' | 'quality' | 'regions';
export interface Legend { name: string; css: string }
interface Frame { fold: number; axis: { origin: number[]; direction: number[] }; dimension: 2 | 3 }

// More triangles than this in all copies together, and the copies that go beyond are left out.
const mostTriangles = 24_000_000;
// Triangles a frame: more are drawn over several frames, so that turning never waits for all of them.
const budgetOfCard = 4_000_000;
const budgetOfProcessor = 20_000;
const sharpEdgeDegrees = 28;
const mostTrianglesWithEdges = 150_000;

export class Viewer {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  private readonly controls: OrbitControls;
  private readonly model = new THREE.Group();
  private readonly mesh = new THREE.Group();
  private readonly marks = new THREE.Group();
  private readonly materials: SurfaceMaterial[] = [];
  private readonly lineMaterials: LineMaterial[] = [];
  private cell: Cell | null = null;
  private binColours: Colour[] = [];
  private centres: Float32Array = new Float32Array();
  private copies: THREE.InstancedMesh | null = null;
  private main: SurfaceMaterial | null = null;
  private picked: THREE.Mesh | null = null;
  private copyLines: THREE.Object3D | null = null;
  private frame: Frame = { fold: 1, axis: { origin: [0, 0, 0], direction: [0, 0, 1] }, dimension: 3 };
  private colouring: Colouring = 'groups';
  private copyCount = 1;
  private clipAxis = 2;
  private clipShare = 1;
  private edges = true;
  private selection: Set<number> | null = null;
  private radius = 1;
  private cellSphere = new THREE.Sphere();
  private modelSphere = new THREE.Sphere();
  private wanted = false;
  private part = 0;
  private readonly budget: number;
  private flight = 0;
  frames = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    const software = drawsInSoftware();
    this.budget = software ? budgetOfProcessor : budgetOfCard;
    // Kept from frame to frame: parts of a large mesh are drawn one after the other.
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !software, alpha: true, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // colours are handed over as they are seen
    this.scene.add(this.model, this.mesh, this.marks);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
    this.resize();
  }

  get hasCell(): boolean {
    return this.cell !== null;
  }

  // --- What there is to see ---

  showPicture(picture: Picture, frame: Frame): Legend[] {
    clear(this.model);
    clear(this.marks);
    this.frame = frame;
    const origin = new THREE.Vector3(...(frame.axis.origin as [number, number, number]));
    this.model.position.set(...picture.offset).sub(origin);
    const legend: Legend[] = [];
    let number = 0;
    for (const group of picture.groups) {
      const atFault = group.name === 'at fault';
      const unnamed = group.name === 'boundary_0';
      const colour: Colour = atFault ? faultColour : unnamed ? groupColour(0) : groupColour(++number);
      if (!unnamed) legend.push({ name: group.name.replace('_', ' '), css: cssOf(colour) });
      if (group.lines) {
        const dark = isDark();
        const shown: Colour = unnamed ? (dark ? [200, 210, 220] : [44, 58, 72]) : colour;
        this.model.add(this.fatLines(gather(picture.positions, group.indices), shown, unnamed ? 1.6 : 2.6));
      } else {
        const material = this.surfaceMaterial();
        material.uniforms.uSectors.value = atFault ? 0 : frame.fold;
        material.uniforms.uShift.value = atFault ? -1e-4 : 0;
        const geometry = surface(gather(picture.positions, group.indices), colour);
        this.model.add(new THREE.Mesh(geometry, material));
        if (group.indices.length / 3 <= mostTrianglesWithEdges) {
          this.model.add(this.sharpEdges(picture.positions, group.indices));
        }
      }
    }
    this.modelSphere = sphereOf(picture.positions).translate(this.model.position);
    this.radius = this.modelSphere.radius || 1;
    if (frame.dimension === 2 && frame.fold > 1) this.model.add(this.sectorDisc());
    this.addAxis();
    this.setAxis();
    this.view('model');
    this.reset();
    return legend;
  }

  /** Where folds that nearly fit miss: model coordinates. */
  showMarks(points: readonly (readonly number[])[]): void {
    for (const child of [...this.marks.children]) if (child.name === 'mark') this.marks.remove(child);
    const geometry = new THREE.SphereGeometry(this.radius * 0.022, 16, 10);
    const origin = this.frame.axis.origin;
    for (const p of points) {
      const material = new THREE.MeshBasicMaterial({ color: new THREE.Color(...faultColour.map((c) => c / 255)), depthTest: false, transparent: true, opacity: 0.85 });
      const ball = new THREE.Mesh(geometry, material);
      ball.name = 'mark';
      ball.renderOrder = 5;
      ball.position.set(p[0]! - origin[0]!, p[1]! - origin[1]!, p[2]! - origin[2]!);
      this.marks.add(ball);
    }
    this.draw();
  }

  showCell(cell: Cell): void {
    this.cell = cell;
    this.frame = { fold: cell.mesh.fold, axis: cell.mesh.axis, dimension: cell.mesh.dimension };
    this.selection = null;
    this.clipShare = 1;
    this.copyCount = 1;
    this.centres = new Float32Array(3 * cell.elementCount);
    for (let e = 0; e < cell.elementCount; ++e) this.centres.set(cell.centre(e), 3 * e);
    this.cellSphere = sphereOf(cell.mesh.nodes);
    const reach = farthestFromAxis(cell.mesh.nodes, this.axis());
    this.modelSphere = new THREE.Sphere(this.cellSphere.center.clone().projectOnVector(this.axis()),
                                        Math.max(reach, this.cellSphere.radius));
    this.radius = this.modelSphere.radius || 1;
    this.rebuild();
    this.view('mesh');
    this.reset();
  }

  view(which: 'model' | 'mesh'): void {
    this.model.visible = which === 'model';
    this.mesh.visible = which === 'mesh';
    for (const child of this.marks.children) if (child.name === 'mark') child.visible = which === 'model';
    this.controls.enableRotate = this.frame.dimension === 3;
    this.draw();
  }

  // --- How it is seen ---

  setColouring(colouring: Colouring): void {
    this.colouring = colouring;
    this.rebuild();
  }

  setEdges(on: boolean): void {
    this.edges = on;
    this.paint();
  }

  /** Copies of the cell, from 1 to the fold; a fraction is a copy on its way to its place. */
  setCopies(count: number): void {
    const whole = Math.ceil(count) !== Math.ceil(this.copyCount);
    this.copyCount = count;
    if (this.clipShare < 1 && whole) this.rebuild();
    this.placeCopies();
    this.draw();
  }

  get mostCopies(): number {
    const shown = this.copies ? this.copies.geometry.getAttribute('position').count / 3 : 1;
    return Math.max(1, Math.min(this.frame.fold, Math.floor(mostTriangles / Math.max(shown, 1))));
  }

  setClip(axis: number, share: number): void {
    this.clipAxis = axis;
    this.clipShare = share;
    this.rebuild();
  }

  select(elements: Set<number> | null): void {
    this.selection = elements;
    this.rebuild();
  }

  flyTo(element: number): void {
    if (!this.cell) return;
    const target = new THREE.Vector3(...this.cell.centre(element));
    const size = this.elementSize(element);
    this.fly(target, (this.viewHeight() / (size * 9)));
  }

  /** As a person with a mouse would: by degrees, and by a factor. */
  turn(across: number, up: number): void {
    if (this.frame.dimension === 2) {
      const step = (2 * this.camera.top) / this.camera.zoom / 12;
      this.camera.position.x -= Math.sign(across) * step;
      this.controls.target.x -= Math.sign(across) * step;
      this.camera.position.y -= Math.sign(up) * step;
      this.controls.target.y -= Math.sign(up) * step;
    } else {
      const arm = this.camera.position.clone().sub(this.controls.target);
      const place = new THREE.Spherical().setFromVector3(new THREE.Vector3(arm.x, arm.z, -arm.y));
      place.theta -= THREE.MathUtils.degToRad(across);
      place.phi = THREE.MathUtils.clamp(place.phi - THREE.MathUtils.degToRad(up), 0.02, Math.PI - 0.02);
      const v = new THREE.Vector3().setFromSpherical(place);
      this.camera.position.copy(this.controls.target).add(new THREE.Vector3(v.x, -v.z, v.y));
    }
    this.controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  reset(): void {
    cancelAnimationFrame(this.flight);
    const sphere = this.mesh.visible && this.copyCount === 1 ? this.cellSphere : this.modelSphere;
    const flat = this.frame.dimension === 2;
    this.camera.up.set(0, flat ? 1 : 0, flat ? 0 : 1);
    this.controls.target.copy(sphere.center);
    const from = flat ? new THREE.Vector3(0, 0, 1) : this.goodDirection();
    this.camera.position.copy(sphere.center).addScaledVector(from, 4 * this.radius + sphere.center.length());
    this.camera.near = -20 * this.radius;
    this.camera.far = 30 * this.radius + 2 * sphere.center.length();
    this.camera.zoom = this.fitZoom(sphere.radius);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /** A small picture of what is seen now. */
  thumbnail(): string {
    if (this.wanted) this.render();
    const small = document.createElement('canvas');
    small.width = 160;
    small.height = 120;
    const { width, height } = this.canvas;
    const scale = Math.max(small.width / width, small.height / height);
    small.getContext('2d')!.drawImage(this.canvas, (small.width - width * scale) / 2,
                                      (small.height - height * scale) / 2, width * scale, height * scale);
    return small.toDataURL('image/webp', 0.8);
  }

  /** Resolves when all parts of the picture are drawn. */
  async settled(): Promise<void> {
    do await new Promise(requestAnimationFrame);
    while (this.wanted || this.part > 0);
  }

  /** Frames a second while the view is turned; for measuring. */
  async measure(frames = 60): Promise<number> {
    const gl = this.renderer.getContext();
    const pixel = new Uint8Array(4);
    const begin = performance.now();
    for (let i = 0; i < frames; ++i) {
      this.turn(360 / frames, 0);
      await new Promise(requestAnimationFrame);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // waits for the picture
    }
    return (1000 * frames) / (performance.now() - begin);
  }

  // --- Making geometry ---

  private axis(): THREE.Vector3 {
    return new THREE.Vector3(...(this.frame.axis.direction as [number, number, number])).normalize();
  }

  private setAxis(): void {
    const axis = this.axis();
    const across = new THREE.Vector3(1, 0, 0);
    if (Math.abs(axis.x) > 0.9) across.set(0, 1, 0);
    across.addScaledVector(axis, -axis.dot(across)).normalize();
    for (const material of this.materials) {
      material.uniforms.uAxis.value.copy(axis);
      material.uniforms.uAcross.value.copy(across);
    }
  }

  private surfaceMaterial(): SurfaceMaterial {
    const material = makeSurfaceMaterial();
    material.uniforms.uFlat.value = this.frame.dimension === 2 ? 1 : 0;
    this.materials.push(material);
    return material;
  }

  private fatLines(positions: Float32Array, colour: Colour, width: number): LineSegments2 {
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(positions);
    const material = new LineMaterial({ color: new THREE.Color(...colour.map((c) => c / 255)), linewidth: width });
    material.resolution.set(this.canvas.clientWidth, this.canvas.clientHeight);
    this.lineMaterials.push(material);
    const lines = new LineSegments2(geometry, material);
    lines.renderOrder = 3;
    return lines;
  }

  private sharpEdges(positions: Float32Array, indices: Uint32Array): THREE.LineSegments {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const edges = new THREE.EdgesGeometry(geometry, sharpEdgeDegrees);
    return new THREE.LineSegments(edges, new THREE.LineBasicMaterial({
      color: 0x1c2733, transparent: true, opacity: 0.55 }));
  }

  // Sectors of a drawing: a disc behind it.
  private sectorDisc(): THREE.Mesh {
    const radius = this.modelSphere.radius + this.modelSphere.center.length();
    const geometry = new THREE.CircleGeometry(radius * 1.04, 180).toNonIndexed();
    tint(geometry, [236, 238, 240]);
    const material = this.surfaceMaterial();
    material.uniforms.uSectors.value = this.frame.fold;
    material.uniforms.uAlpha.value = 0.42;
    material.transparent = true;
    const disc = new THREE.Mesh(geometry, material);
    disc.position.copy(this.model.position).negate();
    disc.position.z -= 1e-3 * radius;
    return disc;
  }

  private addAxis(): void {
    const axis = this.axis();
    const along = this.modelSphere.center.clone().projectOnVector(axis);
    const points: number[] = [];
    if (this.frame.dimension === 3) {
      const dashes = 25, half = 1.25 * this.radius;
      for (let i = 0; i < dashes; ++i) {
        for (const end of [i, i + 0.62]) {
          points.push(...along.clone().addScaledVector(axis, half * ((2 * end) / dashes - 1)).toArray());
        }
      }
    } else {
      const arm = 0.03 * this.radius;
      points.push(-arm, 0, 0, arm, 0, 0, 0, -arm, 0, 0, arm, 0);
    }
    if (this.frame.fold > 1) {
      this.marks.add(this.fatLines(new Float32Array(points), isDark() ? [236, 160, 80] : [176, 92, 16], 1.6));
    }
  }

  private kept(): Uint8Array | null {
    if (this.clipShare >= 1 || !this.cell || this.copyCount > 1) return null;
    const c = this.clipAxis;
    let least = Infinity, most = -Infinity;
    for (let i = c; i < this.cell.mesh.nodes.length; i += 3) {
      least = Math.min(least, this.cell.mesh.nodes[i]!);
      most = Math.max(most, this.cell.mesh.nodes[i]!);
    }
    const at = least + this.clipShare * (most - least);
    const kept = new Uint8Array(this.cell.elementCount);
    for (let e = 0; e < kept.length; ++e) kept[e] = this.centres[3 * e + c]! <= at ? 1 : 0;
    return kept;
  }

  private colourOf(face: number, element: number): Colour {
    const cell = this.cell!;
    if (this.colouring === 'quality') return this.binColours[cell.bin(element)]!;
    const kind = cell.kind[face]!;
    if (this.colouring === 'groups' && cell.mesh.dimension === 3) {
      if (kind === kLower) return lowerColour;
      if (kind === kHigher) return higherColour;
      if (kind >= 0) return groupColour(cell.markers[kind] === 0 ? 0 : kind + (cell.markers[0] === 0 ? 0 : 1));
    }
    if (cell.regions.length > 1 || cell.mesh.dimension === 2) {
      return regionColour(cell.regions.length > 1 ? cell.regions.indexOf(cell.mesh.regions[element]!) + 1 : 0);
    }
    return this.colouring === 'groups' ? innerColour : regionColour(0);
  }

  // The faces that are to be seen, and those of the selected elements.
  private rebuild(): void {
    const cell = this.cell;
    if (!cell) return;
    const last = cell.histogram.counts.length - 1;
    this.binColours = cell.histogram.counts.map((_, bin) => qualityColour((bin + 0.5) / last));
    const kept = this.kept();
    const solid = cell.mesh.dimension === 3;
    const shown: number[] = [];
    for (let f = 0; f < cell.inside.length; ++f) {
      const a = cell.inside[f]!, b = cell.outside[f]!;
      const first = kept ? kept[a] === 1 : true;
      const second = b >= 0 && (kept ? kept[b] === 1 : true);
      if (first !== second || (solid && cell.kind[f]! !== kInner && (first || second) && b < 0)) shown.push(f);
    }
    const positions = new Float32Array(9 * shown.length);
    // Four bytes a corner: three are turned into four by some drivers, at every draw.
    const colours = new Uint8Array(12 * shown.length);
    const nodes = cell.mesh.nodes;
    // In an order that goes all over the mesh: its first part alone gives an impression of the whole.
    const stride = coprimeNear(shown.length * 0.618, shown.length);
    for (let i = 0, at = 0; i < shown.length; ++i, at = (at + stride) % shown.length) {
      const f = shown[at]!;
      const element = kept && kept[cell.inside[f]!] === 0 ? cell.outside[f]! : cell.inside[f]!;
      const colour = this.colourOf(f, element);
      for (let c = 0; c < 3; ++c) {
        const node = 3 * cell.faces[3 * f + c]!;
        const to = 9 * i + 3 * c;
        positions[to] = nodes[node]!;
        positions[to + 1] = nodes[node + 1]!;
        positions[to + 2] = nodes[node + 2]!;
        colours.set(colour, 12 * i + 4 * c);
      }
    }
    clear(this.mesh);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('tint', new THREE.BufferAttribute(colours, 4, true));
    this.main = this.surfaceMaterial();
    this.copies = new THREE.InstancedMesh(geometry, this.main as unknown as THREE.Material, Math.max(1, this.frame.fold));
    this.copies.frustumCulled = false;
    this.mesh.add(this.copies);
    this.picked = null;
    if (this.selection) {
      this.picked = this.selectedMesh(cell, this.selection);
      this.mesh.add(this.picked);
    }
    this.copyLines = solid ? null : this.planarLines(cell);
    if (this.copyLines) this.mesh.add(this.copyLines);
    this.placeCopies();
    this.paint();
  }

  private selectedMesh(cell: Cell, selection: Set<number>): THREE.Mesh {
    const corners = cell.mesh.dimension + 1;
    const faces = corners === 3 ? [[0, 1, 2]] : [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
    const positions = new Float32Array(9 * faces.length * selection.size);
    let at = 0;
    for (const e of selection) {
      for (const face of faces) {
        for (const corner of face) {
          const node = 3 * cell.mesh.elements[e * cell.mesh.nodesPerElement + corner]!;
          for (let c = 0; c < 3; ++c) positions[at++] = cell.mesh.nodes[node + c]!;
        }
      }
    }
    const material = this.surfaceMaterial();
    material.uniforms.uEdges.value = 0.8;
    material.uniforms.uShift.value = -2e-4;
    const mesh = new THREE.Mesh(surface(positions, selectedColour), material as unknown as THREE.Material);
    mesh.renderOrder = 2;
    return mesh;
  }

  private planarLines(cell: Cell): THREE.Group {
    const lines = new THREE.Group();
    const add = (facets: ArrayLike<number>, chosen: (i: number) => boolean, colour: Colour, width: number): void => {
      const k = cell.mesh.nodesPerFacet;
      const points: number[] = [];
      for (let i = 0; i < facets.length / k; ++i) {
        if (!chosen(i)) continue;
        for (const end of [0, 1]) {
          const node = 3 * facets[i * k + end]!;
          points.push(cell.mesh.nodes[node]!, cell.mesh.nodes[node + 1]!, 0);
        }
      }
      if (points.length > 0) lines.add(this.fatLines(new Float32Array(points), colour, width));
    };
    cell.markers.forEach((marker, number) => {
      const colour: Colour = marker === 0 ? (isDark() ? [206, 214, 222] : [40, 52, 64]) : groupColour(number + 1);
      add(cell.mesh.boundary, (i) => cell.mesh.boundaryMarkers[i] === marker, colour, 2.2);
    });
    add(cell.mesh.lowerFacets, () => true, lowerColour, 3.4);
    add(cell.mesh.higherFacets, () => true, higherColour, 3.4);
    return lines;
  }

  private placeCopies(): void {
    if (!this.copies) return;
    const count = Math.min(Math.ceil(this.copyCount), this.mostCopies);
    const matrix = new THREE.Matrix4();
    const axis = this.axis();
    const step = (2 * Math.PI) / this.frame.fold;
    for (let s = 0; s < count; ++s) {
      this.copies.setMatrixAt(s, matrix.makeRotationAxis(axis, step * Math.min(s, Math.max(this.copyCount - 1, 0))));
    }
    this.copies.count = count;
    this.copies.instanceMatrix.needsUpdate = true;
    if (this.copyLines) this.copyLines.visible = count === 1;
    const clip = this.main?.uniforms.uClip.value;
    if (clip && this.clipShare < 1 && this.copyCount > 1) {
      const sphere = this.modelSphere;
      const normal = new THREE.Vector3().setComponent(this.clipAxis, 1);
      clip.set(normal.x, normal.y, normal.z,
               sphere.center.getComponent(this.clipAxis) + sphere.radius * (2 * this.clipShare - 1));
    } else {
      clip?.copy(noClip);
    }
  }

  // --- Drawing ---

  private paint(): void {
    if (this.main) {
      this.main.uniforms.uEdges.value = this.edges ? 0.6 : 0;
      this.main.uniforms.uAlternate.value = this.colouring === 'groups' ? 0.1 : 0;
      this.main.uniforms.uAlpha.value = this.selection ? 0.14 : 1;
      this.main.transparent = this.selection !== null;
      this.main.depthWrite = this.selection === null;
    }
    this.draw();
  }

  draw(): void {
    this.part = 0;
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => this.render());
  }

  // One part of the picture; the next frame draws the next one.
  private render(): void {
    this.wanted = false;
    const geometry = this.mesh.visible ? this.copies?.geometry : undefined;
    const triangles = geometry ? geometry.getAttribute('position').count / 3 : 0;
    const each = Math.max(1, Math.floor(this.budget / Math.max(this.copies?.count ?? 1, 1)));
    const parts = Math.max(1, Math.ceil(triangles / each));
    geometry?.setDrawRange(3 * this.part * each, 3 * each);
    // Lines and marks come with the first part, to be seen while turning, and again on top of all.
    const extras = [this.marks, this.picked, this.copyLines].filter((object) => object !== null);
    const shown = extras.map((object) => object.visible);
    if (this.part > 0 && this.part + 1 < parts) for (const object of extras) object.visible = false;
    if (this.part === 0) this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    extras.forEach((object, i) => { object.visible = shown[i]!; });
    ++this.frames;
    this.canvas.dataset.frames = String(this.frames);
    this.part = this.part + 1 < parts ? this.part + 1 : 0;
    if (this.part === 0) return;
    this.wanted = true;
    requestAnimationFrame(() => this.render());
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    const aspect = width / height;
    this.camera.left = -aspect;
    this.camera.right = aspect;
    this.camera.updateProjectionMatrix();
    for (const material of this.lineMaterials) material.resolution.set(width, height);
    this.draw();
  }

  private viewHeight(): number {
    return this.camera.top - this.camera.bottom;
  }

  private fitZoom(radius: number): number {
    const aspect = this.camera.right / this.camera.top;
    return (0.92 * Math.min(1, aspect)) / (radius || 1);
  }

  // Obliquely from above, the axis upright where it is not lying.
  private goodDirection(): THREE.Vector3 {
    return new THREE.Vector3(0.62, -0.66, 0.55).normalize();
  }

  private elementSize(element: number): number {
    const cell = this.cell!;
    const centre = new THREE.Vector3(...cell.centre(element));
    let size = 0;
    for (let i = 0; i <= cell.mesh.dimension; ++i) {
      const node = 3 * cell.mesh.elements[element * cell.mesh.nodesPerElement + i]!;
      const corner = new THREE.Vector3().fromArray(cell.mesh.nodes, node);
      size = Math.max(size, corner.distanceTo(centre));
    }
    return size || this.radius;
  }

  private fly(target: THREE.Vector3, zoom: number): void {
    cancelAnimationFrame(this.flight);
    const from = this.controls.target.clone(), fromZoom = this.camera.zoom;
    const arm = this.camera.position.clone().sub(from);
    const length = matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : 450;
    const begin = performance.now();
    const step = (): void => {
      const t = length === 0 ? 1 : Math.min((performance.now() - begin) / length, 1);
      const eased = t * t * (3 - 2 * t);
      this.controls.target.lerpVectors(from, target, eased);
      this.camera.position.copy(this.controls.target).add(arm);
      this.camera.zoom = fromZoom * (zoom / fromZoom) ** eased;
      this.camera.updateProjectionMatrix();
      this.controls.update();
      this.draw();
      if (t < 1) this.flight = requestAnimationFrame(step);
    };
    step();
  }
}

// Whether there is no graphics card, or none that the browser trusts.
function drawsInSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** A number near `wanted` that has no divisor with `count` in common. */
function coprimeNear(wanted: number, count: number): number {
  const divisor = (a: number, b: number): number => (b === 0 ? a : divisor(b, a % b));
  let stride = Math.max(1, Math.floor(wanted));
  while (divisor(stride, count) > 1) ++stride;
  return stride;
}

function isDark(): boolean {
  return matchMedia('(prefers-color-scheme: dark)').matches;
}

function clear(group: THREE.Group): void {
  group.traverse((object) => {
    const drawn = object as THREE.Mesh;
    drawn.geometry?.dispose();
    if (drawn.material && !Array.isArray(drawn.material)) drawn.material.dispose();
  });
  group.clear();
}

function tint(geometry: THREE.BufferGeometry, colour: Colour): void {
  const count = geometry.getAttribute('position').count;
  const colours = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) colours.set(colour, 4 * i);
  geometry.setAttribute('tint', new THREE.BufferAttribute(colours, 4, true));
}

function surface(positions: Float32Array, colour: Colour): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  tint(geometry, colour);
  return geometry;
}

function gather(positions: Float32Array, indices: Uint32Array): Float32Array {
  const result = new Float32Array(3 * indices.length);
  for (let i = 0; i < indices.length; ++i) {
    const at = 3 * indices[i]!;
    result[3 * i] = positions[at]!;
    result[3 * i + 1] = positions[at + 1]!;
    result[3 * i + 2] = positions[at + 2]!;
  }
  return result;
}

function sphereOf(positions: Float32Array): THREE.Sphere {
  const box = new THREE.Box3().setFromArray(positions);
  const centre = box.getCenter(new THREE.Vector3());
  let radius2 = 0;
  for (let i = 0; i < positions.length; i += 3) {
    radius2 = Math.max(radius2, (positions[i]! - centre.x) ** 2 + (positions[i + 1]! - centre.y) ** 2 +
                                (positions[i + 2]! - centre.z) ** 2);
  }
  return new THREE.Sphere(centre, Math.sqrt(radius2));
}

function farthestFromAxis(positions: Float32Array, axis: THREE.Vector3): number {
  let farthest = 0;
  const p = new THREE.Vector3();
  for (let i = 0; i < positions.length; i += 3) {
    p.fromArray(positions, i);
    farthest = Math.max(farthest, p.cross(axis).length());
  }
  return farthest;
}
