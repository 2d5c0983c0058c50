// The geometry of a report: base64 of a zlib stream of arrays, as README.md describes them.

export class ReportError extends Error {}

const count_of = (value) => {
  if (!Number.isSafeInteger(value) || value < 0) throw new ReportError('a count is no count');
  return value;
};

function decoded(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Inflates exactly `size` bytes. */
async function inflated(bytes, size) {
  const whole = new Uint8Array(size);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  let at = 0;
  for (const reader = stream.getReader(); ;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (at + value.length > size) throw new ReportError('the geometry is longer than it says');
    whole.set(value, at);
    at += value.length;
  }
  if (at !== size) throw new ReportError('the geometry is shorter than it says');
  return whole.buffer;
}

// Four values of 16 bits a point: coordinates, and the deviation plus 32768.
function interleaved(columns, n) {
  const points = new Uint16Array(4 * n);
  for (let axis = 0; axis < 4; ++axis) {
    const shift = axis === 3 ? 32768 : 0;
    for (let i = 0, at = axis * n; i < n; ++i) points[4 * i + axis] = columns[at + i] + shift;
  }
  return points;
}

/** The corners of all triangles, three coordinates each. */
function corners_of(coordinates, triangles, v) {
  const corners = new Float32Array(3 * triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const vertex = triangles[i];
    if (vertex >= v) throw new ReportError('a triangle names a vertex that is not there');
    corners[3 * i] = coordinates[vertex];
    corners[3 * i + 1] = coordinates[v + vertex];
    corners[3 * i + 2] = coordinates[2 * v + vertex];
  }
  return corners;
}

/**
 * Reads the element #emax-geometry: { points, corners, deviations } with four values a point, nine
 * coordinates and one deviation a triangle. Raises ReportError, or what the browser raises, where the
 * data are damaged.
 */
export async function read_geometry(element, shape) {
  if (typeof DecompressionStream === 'undefined') {
    throw new ReportError('this browser is too old to read the geometry');
  }
  const [n, v, t] = [shape.points, shape.vertices, shape.triangles].map(count_of);
  const text = element.textContent.trim();
  element.textContent = ''; // megabytes
  const buffer = await inflated(decoded(text), 8 * n + 12 * v + 16 * t);
  return {
    points: interleaved(new Uint16Array(buffer, 0, 4 * n), n),
    corners: corners_of(new Float32Array(buffer, 8 * n, 3 * v), new Uint32Array(buffer, 8 * n + 12 * v, 3 * t), v),
    deviations: new Float32Array(buffer, 8 * n + 12 * v + 12 * t, t) };
}
