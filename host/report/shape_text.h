#pragma once

#include <string>

#include "host/features/shapes.h"
#include "host/report/json_parts.h"

namespace emax {

// "plane", "cylinder" or "sphere".
std::string kind_of(const Shape& shape);
// Its equation on one line.
std::string equation_text(const Shape& shape);
// The same in JSON: normal and offset; radius, axis and centre; or radius and centre.
Json equation_json(const Shape& shape);

}  // namespace emax
