// convert_mesh FROM TO [UNIT]: reads a mesh as emax does and writes it as emax does, in this unit.
// Prints the unit that FROM states. An Error goes to standard error; the exit code is then 1.

#include <fmt/format.h>

#include "host/files/mesh_file.h"
#include "sw_model/base/error.h"

int main(int count, char** arguments) {
  if (count < 3) return 2;
  try {
    const emax::MeshFile file = emax::read_mesh_file(arguments[1]);
    emax::write_mesh(arguments[2], file.mesh,
                     {.unit = count > 3 ? emax::unit_named(arguments[3]) : std::nullopt});
    fmt::print("{}\n", file.unit ? file.unit->name : "none");
    return 0;
  } catch (const emax::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
