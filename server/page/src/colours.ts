// Colours of what is drawn, as sRGB bytes. Ones that stand for different things differ in lightness too.

export type Colour = [number, number, number];

export const lowerColour: Colour = [205, 60, 54];
export const higherColour: Colour = [46, 98, 205];
export const innerColour: Colour = [222, 214, 196];
export const selectedColour: Colour = [240, 140, 20];
export const faultColour: Colour = [220, 40, 40];

const groups: Colour[] = [
  [142, 158, 172], [96, 168, 142], [214, 168, 78], [158, 128, 190], [110, 170, 196], [196, 130, 142],
  [150, 176, 92], [204, 146, 96], [120, 140, 200], [188, 170, 128],
];

export function groupColour(number: number): Colour {
  return groups[number % groups.length]!;
}

/** Regions lie under groups: paler, so that these stand out. */
export function regionColour(number: number): Colour {
  return groupColour(number).map((c) => Math.round(0.5 * c + 0.5 * 246)) as Colour;
}

// From bad to good, dark red over sand to deep teal: read by lightness too, and by those who see no red.
const ramp: Colour[] = [[134, 24, 40], [196, 74, 52], [226, 138, 84], [238, 196, 140], [214, 220, 196],
                        [146, 196, 190], [84, 158, 168], [42, 116, 140], [20, 78, 110]];

/** `share`: 0 bad to 1 good. */
export function qualityColour(share: number): Colour {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const i = Math.min(Math.floor(at), ramp.length - 2);
  const t = at - i;
  return [0, 1, 2].map((c) => Math.round(ramp[i]![c]! * (1 - t) + ramp[i + 1]![c]! * t)) as Colour;
}

export function cssOf(colour: Colour): string {
  return `rgb(${colour.join(' ')})`;
}
