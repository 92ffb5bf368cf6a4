// From where the 3D view looks, and the matrix that follows from it.
import { roundBelow } from "./ticks.ts";

export interface Look {
  turn_deg: number;  // 0: the image's upper border is at the back
  tilt_deg: number;  // 90: from above
  zoom: number;
}

export const kFirstLook: Look = { turn_deg: -25, tilt_deg: 45, zoom: 1.25 };

export function boundedLook(look: Look): Look {
  return {
    turn_deg: ((look.turn_deg + 540) % 360 + 360) % 360 - 180,
    tilt_deg: Math.max(0, Math.min(90, look.tilt_deg)),
    zoom: Math.max(0.5, Math.min(20, look.zoom)),
  };
}

const kRest_ms = 60;
const kHand_ms = 500;  // steps further apart are no turn

// How long after a step of a turn the view rests, by how long the step before was ago: a machine that draws slowly brings
// the hand's steps late, and would be slower still if it drew the fine picture between them.
export const restAfter_ms = (since_ms: number): number => (since_ms < kHand_ms ? Math.max(kRest_ms, 1.5 * since_ms) : kRest_ms);

// So that the heights take up about a fifth of the width; 1 where they do by themselves.
export function suggestedExaggeration(height_um: number, width_um: number): number {
  if (!(height_um > 0) || !(width_um > 0)) return 1;
  return Math.max(1, roundBelow((0.2 * width_um) / height_um));
}

// Column-major 4 x 4 for WebGL, parallel projection: µm about the map's middle to the cube -1..1. z is exaggerated
// about middle_z_um; half_um: half of the largest extent, which fills the shorter side of the canvas.
export function matrixOf(look: Look, half_um: number, middle_z_um: number, exaggeration: number, aspect: number): Float32Array {
  const turn = (look.turn_deg * Math.PI) / 180;
  const tilt = (look.tilt_deg * Math.PI) / 180;
  const [ct, st] = [Math.cos(turn), Math.sin(turn)];
  const [ci, si] = [Math.cos(tilt), Math.sin(tilt)];
  const size = look.zoom / half_um;
  const wide = aspect > 1 ? size / aspect : size;
  const high = aspect > 1 ? size : size * aspect;
  const deep = 0.25 / half_um;  // independent of the zoom, so that nothing is cut away in front
  // Turned about z, then tilted about the screen's x: right, up, towards the eye.
  const right = [ct, -st, 0];
  const up = [st * si, ct * si, ci];
  const near = [-st * ci, -ct * ci, si];
  const matrix = new Float32Array(16);
  for (let axis = 0; axis < 3; ++axis) {
    const stretch = axis === 2 ? exaggeration : 1;
    matrix[4 * axis] = right[axis]! * wide * stretch;
    matrix[4 * axis + 1] = up[axis]! * high * stretch;
    matrix[4 * axis + 2] = -near[axis]! * deep * stretch;
  }
  const lift = -middle_z_um * exaggeration;
  matrix[12] = right[2]! * wide * lift;
  matrix[13] = up[2]! * high * lift;
  matrix[14] = -near[2]! * deep * lift;
  matrix[15] = 1;
  return matrix;
}
