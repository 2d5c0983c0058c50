#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/fuzz/target.h"
#include "tests/support/temporary_folder.h"

namespace emax::fuzz {

// The folder of this process, which is empty at first.
const test::TemporaryFolder& folder();

// Writes `name` in folder() anew with these bytes, and gives its path.
std::filesystem::path write(std::string_view name, Input bytes);

// Reads a file of these bytes with every reader of its ending, which begins with a dot: as a cloud,
// without its invalid points, and as a mesh. A mesh that was read comes back the same from each
// format that keeps every bit. Throws the last Error of a reader.
void read_file(Input bytes, std::string_view ending);

// The same as a mesh alone.
void read_sound_mesh(const std::filesystem::path& path);

// A tetrahedron as a file of this ending.
std::string tetrahedron(std::string_view ending);

}  // namespace emax::fuzz
