// The point under the pointer.
import { Matrix4, Vector3 } from 'three';

const REACH = 10; // pixels

/**
 * Of the points within REACH of (x, y) in the view, the one nearest to the viewer: { place, deviation },
 * place relative to the origin. Null where there is none, or points are not shown. Linear in the points.
 */
export function pick(view, x, y) {
  if (!view.points.visible) return null;
  const { stage, shape, camera, section } = view;
  const { points } = view.geometry;
  const [sx, sy, sz] = shape.step;
  const m = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
  const [width, height] = [stage.clientWidth / 2, stage.clientHeight / 2];
  const plane = section.value;
  let best = null;
  let nearest = Infinity;
  for (let i = 0; i < points.length; i += 4) {
    const [px, py, pz] = [points[i] * sx, points[i + 1] * sy, points[i + 2] * sz];
    const across = (m[0] * px + m[4] * py + m[8] * pz + m[12] + 1) * width - x;
    const down = (1 - m[1] * px - m[5] * py - m[9] * pz - m[13]) * height - y;
    const away = across * across + down * down;
    if (away > REACH * REACH || plane.x * px + plane.y * py + plane.z * pz > plane.w) continue;
    // A pixel aside counts as a hundredth of the depth of the scene's box.
    const depth = m[2] * px + m[6] * py + m[10] * pz + m[14] + Math.sqrt(away) * 1e-3;
    if (depth < nearest) {
      nearest = depth;
      best = i;
    }
  }
  if (best === null) return null;
  return {
    place: new Vector3(points[best] * sx, points[best + 1] * sy, points[best + 2] * sz),
    deviation: (points[best + 3] - 32768) * shape.deviation_step };
}
