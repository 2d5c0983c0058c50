# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that runs the main job on a laser scan.

# json_value FILE KEY: the first value of that key, without quotes.
json_value() {
  grep -o "\"$2\" *: *[^,}]*" "$1" | head -n 1 | sed 's/^[^:]*: *//; s/[" ]//g'
}

verb_demo() {
  need data
  verb_build release emax emax_worker
  verb_data
  local emax=build/release/bin/emax cloud=data/bunny00.off out=build/demo device
  local mesh=$out/bunny.ply
  rm -rf "$out"
  mkdir -p "$out"
  timed optimize "$emax" optimize "$cloud" --max-error 0.321% -o "$mesh" --seed 1 \
    --json "$out/optimize.json" --report "$out/bunny.html" --picture "$out/bunny.png"
  for device in cpu sim; do
    timed "error on $device" "$emax" error "$cloud" "$mesh" --device $device \
      --json "$out/$device.json"
  done
  timed verify "$emax" verify "$mesh.certificate.json" --cloud "$cloud"

  timed "optimize building" "$emax" optimize data/building.ply --max-error 0.5% --effort quick --time 120 \
    -o "$out/building.ply" --report "$out/building.html" --picture "$out/building.png"

  local cpu_bits sim_bits
  cpu_bits=$(json_value "$out/cpu.json" e_max_squared_bits)
  sim_bits=$(json_value "$out/sim.json" e_max_squared_bits)
  cat <<TEXT

cloud           $cloud, $(json_value "$out/optimize.json" points) points
reconstruction  $(json_value "$out/optimize.json" reconstruction_triangles) triangles
best mesh       $mesh, $(json_value "$out/optimize.json" triangles) triangles
e_max           $(json_value "$out/optimize.json" e_max), at most $(json_value "$out/optimize.json" epsilon) allowed
evaluations     $(json_value "$out/optimize.json" evaluations)
device sim      $(json_value "$out/sim.json" blocks) blocks, $(json_value "$out/sim.json" pairs) pairs, $(json_value "$out/sim.json" cycles) cycles
e_max² bits     $cpu_bits on cpu, $sim_bits on sim
certificate     $mesh.certificate.json, verified
reports         $out/bunny.html, $out/building.html: open them in a browser
pictures        $out/bunny.png, $out/building.png
TEXT
  if [ -z "$cpu_bits" ] || [ "$cpu_bits" != "$sim_bits" ]; then
    fail "cpu and sim differ in e_max²"
  fi
}
