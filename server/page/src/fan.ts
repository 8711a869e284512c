import { $ } from './dom';

// What the page is about, before there is anything to see: a ring of triangles, one cell in colour.
export function drawFan(): void {
  const place = $('fan') as unknown as SVGElement;
  const sectors = 12, radii = [34, 62, 90, 112];
  for (let s = sectors - 1; s >= 0; --s) {
    for (let ring = 0; ring + 1 < radii.length; ++ring) {
      const at = (r: number, k: number): string => {
        const angle = (2 * Math.PI * (k + r * 0.5)) / sectors;
        return `${(120 + radii[r]! * Math.cos(angle)).toFixed(1)},${(120 - radii[r]! * Math.sin(angle)).toFixed(1)}`;
      };
      for (const corners of [[at(ring, s), at(ring + 1, s), at(ring, s + 1)], [at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)]]) {
        const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
        path.setAttribute('d', `M${corners.join(' ')}Z`);
        if (s === 0) path.setAttribute('class', 'one');
        place.append(path);
      }
    }
  }
}
