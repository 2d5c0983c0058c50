// meshoptimizer's WebAssembly module in a process of its own, for emax_decimation_benchmark.
//
// usage: node meshoptimizer.mjs MODULE VERSION FOLDER. The protocol stands in
// tests/benchmarks/decimation/external_tool.h.

import {readFileSync, writeFileSync} from 'node:fs';
import {createInterface} from 'node:readline';
import {pathToFileURL} from 'node:url';

const [module, version, folder] = process.argv.slice(2);
const {MeshoptSimplifier} = await import(pathToFileURL(module));
await MeshoptSimplifier.ready;

// `update` also moves the vertices that stay.
const SETS = [
  {name: 'simplifyWithUpdate, to a number', update: true, flags: []},
  {name: 'simplifyWithUpdate, to a number, LockBorder', update: true, flags: ['LockBorder']},
  {name: 'simplifyWithUpdate, target_error', update: true, tolerance: true, flags: []},
  {name: 'simplifyWithUpdate, target_error, LockBorder', update: true, tolerance: true, flags: ['LockBorder']},
  {name: 'simplifyWithUpdate, to a number, RegularizeLight', update: true, flags: ['RegularizeLight']},
  {name: 'simplify, to a number', flags: []},
  {name: 'simplify, target_error', tolerance: true, flags: []},
];
const ANY_ERROR = 1e9;

function view(name, Kind) {
  const bytes = readFileSync(name);
  return new Kind(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
}

// The vertices that triangles use, in their order of use.
function compacted(indices, positions) {
  const [remap, count] = MeshoptSimplifier.compactMesh(indices);
  const vertices = new Float64Array(3 * count);
  remap.forEach((to, from) => {
    if (to !== 0xffffffff) vertices.set(positions.subarray(3 * from, 3 * from + 3), 3 * to);
  });
  return vertices;
}

function called({set, parameter}) {
  const {update, tolerance, flags} = SETS[set];
  let indices = view(`${folder}/start/triangles.u32`, Uint32Array);
  const positions = Float32Array.from(view(`${folder}/start/vertices.f64`, Float64Array));
  const target = tolerance ? 0 : Math.min(indices.length, 3 * Math.floor(parameter));
  const error = tolerance ? parameter : ANY_ERROR;
  const all = ['ErrorAbsolute', ...flags];
  const before = process.cpuUsage();
  if (update) {
    const [left] = MeshoptSimplifier.simplifyWithUpdate(indices, positions, 3, new Float32Array(), 0, [], null, target,
                                                        error, all);
    indices = indices.slice(0, left);
  } else {
    [indices] = MeshoptSimplifier.simplify(indices, positions, 3, target, error, all);
  }
  const {user, system} = process.cpuUsage(before);
  const vertices = compacted(indices, positions);
  writeFileSync(`${folder}/result/vertices.f64`, vertices);
  writeFileSync(`${folder}/result/triangles.u32`, indices);
  return {seconds: (user + system) / 1e6};
}

function answered(request) {
  try {
    return called(JSON.parse(request));
  } catch (error) {
    return {failure: String(error.message)};
  }
}

const say = (answer) => process.stdout.write(JSON.stringify(answer) + '\n');
say({
  name: 'meshoptimizer in WebAssembly', version,
  sets: SETS.map(({name, tolerance}) => ({name, parameter: tolerance ? 'tolerance' : 'triangles'})),
});
for await (const line of createInterface({input: process.stdin})) say(answered(line));
