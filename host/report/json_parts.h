#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/report/certificate_file.h"
#include "host/report/error_report.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/model/normalization.h"
#include "sw_model/protocol/device.h"

namespace emax {

// Parts that results and certificates have in common. Keys keep their order.
using Json = nlohmann::ordered_json;

inline constexpr const char* kBound = "one-sided";  // every cloud point within epsilon of the mesh
// Also the whole mesh within epsilon_back of the reference, and the whole reference within epsilon
// of the mesh.
inline constexpr const char* kTwoSidedBound = "two-sided";

// Reads a whole number that fits T. Throws nlohmann's type_error otherwise, where get() would
// convert it.
template <typename T>
void get_count(const Json& json, T& count) {
  if (!json.is_number_unsigned() || json > std::numeric_limits<T>::max()) {
    throw nlohmann::json::type_error::create(302, "a count is no whole number", &json);
  }
  json.get_to(count);
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

std::string bits_text(std::uint32_t bits);  // "0x%08x"
Json to_json(const Normalization& transform);
Normalization normalization_from_json(const Json& json);
Json to_json(const MeshValidity& validity);
MeshValidity validity_from_json(const Json& json);
Json to_json(const MeshTopology& topology);
MeshTopology topology_from_json(const Json& json);
Json to_json(const DeviceCounters& counters);
// The excluded points, each with its index in the file and its distance.
Json excluded_to_json(const CertifiedError& error);
Json to_json(const ErrorReport& report);
Json to_json(const ReferenceBound& reference);

}  // namespace emax
