// One material for all surfaces: flat light from the eye, edges of elements, sectors about the axis, a
// clip plane. Normals and edges come from the pixel's neighbours, so that a corner needs a place and a
// colour and nothing else.
import * as THREE from 'three';

const vertexShader = /* glsl */ `
  attribute vec4 tint;
  uniform float uShift;
  uniform float uAlternate;
  varying vec3 vTint;
  varying vec3 vSeen;
  varying vec3 vPlace;
  varying vec3 vCorner;
  void main() {
    vec4 place = vec4(position, 1.0);
    #ifdef USE_INSTANCING
      place = instanceMatrix * place;
    #endif
    vec4 world = modelMatrix * place;
    vec4 seen = viewMatrix * world;
    vTint = tint.rgb;
    #ifdef USE_INSTANCING
      // Neighbouring copies are told apart by a shade.
      if (uAlternate > 0.0 && gl_InstanceID % 2 == 1) vTint *= 1.0 - uAlternate;
    #endif
    vSeen = seen.xyz;
    vPlace = world.xyz;
    int corner = gl_VertexID % 3;
    vCorner = vec3(corner == 0, corner == 1, corner == 2);
    gl_Position = projectionMatrix * seen;
    gl_Position.z += uShift * gl_Position.w;
  }
`;

const fragmentShader = /* glsl */ `
  uniform float uFlat;
  uniform float uAlpha;
  uniform float uEdges;
  uniform vec3 uEdgeColour;
  uniform vec4 uClip;
  uniform float uSectors;
  uniform vec3 uAxis;
  uniform vec3 uAcross;
  varying vec3 vTint;
  varying vec3 vSeen;
  varying vec3 vPlace;
  varying vec3 vCorner;
  void main() {
    if (dot(vPlace, uClip.xyz) > uClip.w) discard;
    vec3 colour = vTint;
    if (uSectors > 1.5) {
      float turn = atan(dot(cross(uAxis, uAcross), vPlace), dot(uAcross, vPlace)) / 6.2831853;
      float at = fract(turn) * uSectors;
      float sector = floor(at);
      vec3 hue = 0.5 + 0.5 * cos(6.2831853 * (fract(sector * 0.61803) + vec3(0.02, 0.36, 0.68)));
      // One sector stands out; the others are quiet.
      vec3 quiet = mix(vec3(0.80), hue, 0.30);
      colour = sector < 0.5 ? mix(vec3(0.95, 0.62, 0.22), hue, 0.1) : quiet;
      colour = mix(colour, vTint, 0.12);
    }
    float light = 1.0;
    if (uFlat < 0.5) {
      vec3 normal = normalize(cross(dFdx(vSeen), dFdy(vSeen)));
      normal *= sign(normal.z + 1e-9);
      float head = max(normal.z, 0.0);
      float key = max(dot(normal, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
      light = 0.46 + 0.28 * head + 0.36 * key;
    }
    colour *= light;
    if (uEdges > 0.0) {
      vec3 width = fwidth(vCorner);
      vec3 near = smoothstep(width * 0.15, width * 1.05, vCorner);
      float edge = 1.0 - min(near.x, min(near.y, near.z));
      // Elements of a few pixels would be all edge.
      float dense = max(width.x, max(width.y, width.z));
      edge *= 1.0 - smoothstep(0.08, 0.45, dense);
      colour = mix(colour, uEdgeColour, edge * uEdges);
    }
    gl_FragColor = vec4(colour, uAlpha);
  }
`;

export interface SurfaceMaterial extends THREE.ShaderMaterial {
  uniforms: {
    uFlat: { value: number }; uAlpha: { value: number }; uEdges: { value: number };
    uEdgeColour: { value: THREE.Vector3 }; uClip: { value: THREE.Vector4 }; uSectors: { value: number };
    uAxis: { value: THREE.Vector3 }; uAcross: { value: THREE.Vector3 }; uShift: { value: number };
    uAlternate: { value: number };
  };
}

export const noClip = new THREE.Vector4(0, 0, 0, 1);

export function makeSurfaceMaterial(): SurfaceMaterial {
  return new THREE.ShaderMaterial({
    vertexShader, fragmentShader, side: THREE.DoubleSide,
    uniforms: {
      uFlat: { value: 0 }, uAlpha: { value: 1 }, uEdges: { value: 0 },
      uEdgeColour: { value: new THREE.Vector3(0.08, 0.11, 0.15) }, uClip: { value: noClip.clone() },
      uSectors: { value: 0 }, uAxis: { value: new THREE.Vector3(0, 0, 1) },
      uAcross: { value: new THREE.Vector3(1, 0, 0) }, uShift: { value: 0 }, uAlternate: { value: 0 },
    },
  }) as unknown as SurfaceMaterial;
}
