// The messages of the worker pool, without their length.
#include "host/worker_pool/message.h"

#include "tests/fuzz/target.h"

namespace emax::fuzz {
namespace {

void require_sound(const TriangleMesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      require(corner < mesh.vertices.size(), "each corner is a vertex");
    }
  }
}

Input body(const Bytes& message) { return Input(message).subspan(kLengthBytes); }

}  // namespace

void read(Input input) {
  const Message message = decode(input);
  if (const auto* points = std::get_if<PointsMessage>(&message)) {
    require_sound(points->bound.reference);
  }
  if (const auto* mesh = std::get_if<MeshMessage>(&message)) require_sound(mesh->result.mesh);
  const Bytes sent = encode(message);
  require(encode(decode(body(sent))) == sent, "a message that was sent is read the same");
}

std::vector<std::string> seeds() {
  const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}}, {{0, 1, 2}}};
  const Message messages[] = {
      PointsMessage{mesh.vertices, {0.1, 0.2, mesh, {1}}},
      RunMessage{7, {"gp3", "schroeder", ParameterValues({{"normals.k", 20}, {"gp3.mu", 2.7}})}},
      StopMessage{},
      ReadyMessage{},
      MeshMessage{7, {mesh, 3, 1, 0, 0.1, 0.2, false, 0, {1, 2, 3, 4}}},
      FailureMessage{7, {FailureReason::kOutOfMemory, "no memory"}},
      UnusableMessage{"no library"}};
  std::vector<std::string> bodies;
  for (const Message& message : messages) {
    const Bytes bytes = encode(message);
    bodies.emplace_back(bytes.begin() + kLengthBytes, bytes.end());
  }
  return bodies;
}

}  // namespace emax::fuzz
