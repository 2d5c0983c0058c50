#pragma once

#include <string_view>

namespace emax {

// The text of a header of the kernel, as it was when this library was built. `path` is any path
// that ends like the header's path in the repository ("…/hls/kernel/point_triangle.h"). Empty for
// other files.
std::string_view kernel_source(std::string_view path);

// The path in the repository; the path itself for other files.
std::string_view repository_path(std::string_view path);

}  // namespace emax
