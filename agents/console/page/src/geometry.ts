import type {Pose} from './types';

export const identity: Pose = {x: 0, y: 0, th: 0};

// A pose in the frame of `a`, in the frame that `a` is in.
export function compose(a: Pose, b: Pose): Pose {
  const c = Math.cos(a.th), s = Math.sin(a.th);
  return {x: a.x + c * b.x - s * b.y, y: a.y + s * b.x + c * b.y, th: a.th + b.th};
}
export function inverse(a: Pose): Pose {
  const c = Math.cos(a.th), s = Math.sin(a.th);
  return {x: -c * a.x - s * a.y, y: s * a.x - c * a.y, th: -a.th};
}
export const degrees = (radians: number) => radians * 180 / Math.PI;
// [degrees] (-180, 180], whole; no -0
export function heading(radians: number): number {
  return Math.round(degrees(Math.atan2(Math.sin(radians), Math.cos(radians)))) || 0;
}
