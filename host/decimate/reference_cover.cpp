#include "host/decimate/reference_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/decimate/local_distance.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr int kMostCuts = 48;  // for one triangle of the reference
// Of the sides of one that begin() could not prove with these. A mesh that comes as near to its
// limit as it may has many such places, and what is not proven is not kept.
constexpr int kMostHalvings = 5;
// A cut by secants leaves at least this share of a side at either end.
constexpr double kLeastPart = 1.0 / 16;

// Squared, of the sum of two unit normals: less is a fold.
constexpr double kLeastTurn = 0.01;
// A cut that leaves less than this share of both sides at one end cuts nothing.
constexpr double kNoPart = 1e-6;

// A triangle of the mesh: a slot, or with this bit the index of one that an edit adds.
constexpr std::uint32_t kAdded = 1u << 31;

// The corner whose side is not that of the two others; 3 if there is none.
std::size_t lone_of(const std::array<double, 3>& side) {
  std::size_t lone = 0;
  while (lone < 3 && ((side[lone] > 0) == (side[(lone + 1) % 3] > 0) ||
                      (side[lone] > 0) == (side[(lone + 2) % 3] > 0))) {
    ++lone;
  }
  return lone;
}

// Of the way from the lone corner to another one, where the sides change.
double share_of(const std::array<double, 3>& side, std::size_t lone, std::size_t to) {
  return side[lone] / (side[lone] - side[to]);
}

// Whether both parts that a cut leaves are smaller than the whole.
bool separates(const std::array<double, 3>& side) {
  const std::size_t lone = lone_of(side);
  const double a = share_of(side, lone, (lone + 1) % 3), b = share_of(side, lone, (lone + 2) % 3);
  return std::max(a, b) > kNoPart && std::min(a, b) < 1 - kNoPart;
}

}  // namespace

// The mesh as it is, or as an edit leaves it. SheetWalk follows it.
class ReferenceCover::Around {
 public:
  explicit Around(double squared_limit)
      : squared_limit_(squared_limit), limit_(std::sqrt(squared_limit)) {}

  void look_at(const EditableMesh& mesh, const SlotTree& tree) {
    mesh_ = &mesh;
    tree_ = &tree;
    edit_ = nullptr;
  }
  // The vertex of the edit must be in its new place in `mesh`.
  void look_at(const EditableMesh& mesh, const MeshEdit& edit) {
    mesh_ = &mesh;
    edit_ = &edit;
    nearby_.clear();
    if (removed_.size() < mesh.slots()) removed_.resize(mesh.slots(), 0);
    ++edits_;
    for (const std::uint32_t slot : edit.removed) removed_[slot] = edits_;
    joined_.clear();
  }

  // More triangles for nearest(), unless the edit removes them.
  void forget() { recalled_.clear(); }
  void recall(std::uint32_t slot) {
    if (!removed(slot)) recalled_.push_back(slot);
  }

  const MeshEdit& edit() const { return *edit_; }
  const Triangle& corners(std::uint32_t id) const {
    return (id & kAdded) != 0 ? edit_->added[id & ~kAdded] : mesh_->triangle(id);
  }
  const Point& position(std::uint32_t vertex) const { return mesh_->position(vertex); }
  std::array<Point, 3> points(std::uint32_t id) const {
    const Triangle& t = corners(id);
    return {position(t[0]), position(t[1]), position(t[2])};
  }
  double squared_distance_to(const Point& p, std::uint32_t id) const {
    return squared_distance(p, points(id));
  }

  std::uint32_t neighbour(std::uint32_t id, std::size_t side) const {
    if ((id & kAdded) != 0) {
      if (joined_.empty()) join();
      return joined_[id & ~kAdded][side];
    }
    const Triangle& t = mesh_->triangle(id);
    return across(id, t[side], t[(side + 1) % 3]);
  }

  void begin_visits() { visited_.clear(); }
  bool visited(std::uint32_t id) const { return std::ranges::find(visited_, id) != visited_.end(); }
  void visit(std::uint32_t id) { visited_.push_back(id); }
  std::span<const std::uint32_t> visited() const { return visited_; }
  double limit() const { return limit_; }

  std::uint32_t nearest(const Point& p) {
    if (edit_ == nullptr) return tree_->nearest(*mesh_, p, squared_limit_).slot;
    if (nearby_.empty()) gather();
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = kNoIndex;
    const auto try_each = [&](const std::vector<std::uint32_t>& ids) {
      for (const std::uint32_t id : ids) {
        const double squared = squared_distance_to(p, id);
        if (squared >= least) continue;
        least = squared;
        nearest = id;
      }
    };
    try_each(nearby_);
    try_each(recalled_);
    return nearest;
  }

 private:
  bool removed(std::uint32_t slot) const { return edit_ != nullptr && removed_[slot] == edits_; }

  // The triangle on the other side of an edge of `id`.
  std::uint32_t across(std::uint32_t id, std::uint32_t from, std::uint32_t to) const {
    for (const std::uint32_t slot : mesh_->slots_at_edge(from, to)) {
      if (slot != kNoIndex && slot != id && !removed(slot)) return slot;
    }
    if (edit_ == nullptr) return kNoIndex;
    for (std::uint32_t i = 0; i < edit_->added.size(); ++i) {
      if ((kAdded | i) != id && has(edit_->added[i], from) && has(edit_->added[i], to)) {
        return kAdded | i;
      }
    }
    return kNoIndex;
  }

  void join() const {
    for (std::uint32_t i = 0; i < edit_->added.size(); ++i) {
      const Triangle& t = edit_->added[i];
      joined_.push_back({across(kAdded | i, t[0], t[1]), across(kAdded | i, t[1], t[2]),
                         across(kAdded | i, t[2], t[0])});
    }
  }

  // Collects the triangles that the edit adds and those at their vertices.
  void gather() {
    for (std::uint32_t i = 0; i < edit_->added.size(); ++i) nearby_.push_back(kAdded | i);
    for (const Triangle& t : edit_->added) {
      for (const std::uint32_t v : t) {
        if (v == edit_->vertex) continue;
        mesh_->for_each_slot_at(v, [&](std::uint32_t slot) {
          if (!removed(slot)) nearby_.push_back(slot);
        });
      }
    }
    sort_once(nearby_);
  }

  double squared_limit_, limit_;
  const EditableMesh* mesh_ = nullptr;
  const SlotTree* tree_ = nullptr;
  const MeshEdit* edit_ = nullptr;
  std::vector<std::uint32_t> removed_;  // the last edit that removed each slot
  std::uint32_t edits_ = 0;
  std::vector<std::uint32_t> nearby_, recalled_, visited_;
  mutable std::vector<std::array<std::uint32_t, 3>> joined_;  // neighbours of the added triangles
};

ReferenceCover::~ReferenceCover() = default;

ReferenceCover::ReferenceCover(std::span<const Triangle> triangles, std::span<const Point> points,
                               double squared_limit, bool recalls)
    : triangles_(triangles),
      points_(points),
      squared_limit_(squared_limit),
      recalls_(recalls),
      first_of_(triangles.size(), kNoIndex),
      unproven_(triangles.size()),
      around_(std::make_unique<Around>(squared_limit)),
      walk_(std::make_unique<SheetWalk<Around>>()),
      answer_of_(points.size(), kNoIndex),
      seen_(triangles.size(), 0) {}

void ReferenceCover::begin(const EditableMesh& mesh, const SlotTree& tree) {
  first_at_.assign(mesh.slots(), kNoIndex);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) prove(t, mesh, tree);
}

bool ReferenceCover::prove(std::uint32_t triangle, const EditableMesh& mesh, const SlotTree& tree) {
  if (proven(triangle)) return true;
  if (first_at_.size() < mesh.slots()) first_at_.resize(mesh.slots(), kNoIndex);
  Around& around = *around_;
  around.look_at(mesh, tree);
  Piece whole;
  for (std::size_t i = 0; i < 3; ++i) whole[i] = {points_[triangles_[triangle][i]], kNoIndex};
  used_.clear();
  const std::uint32_t middle = around.nearest((whole[0].at + whole[1].at + whole[2].at) / 3);
  if (middle == kNoIndex) return false;
  if (rests_on(whole, middle, around)) {
    use(middle);
  } else {
    for (Corner& corner : whole) {
      corner.near = around.nearest(corner.at);
      if (corner.near == kNoIndex) return false;
    }
    if (!prove_thoroughly(whole, around)) return false;
  }
  for (const std::uint32_t slot : used_) add_support(triangle, slot);
  --unproven_;
  return true;
}

bool ReferenceCover::permits(const EditableMesh& mesh, const AssignedPoints& assigned,
                             const MeshEdit& edit, bool tolerant) {
  affected_.clear();
  given_up_.clear();
  anew_.clear();
  ++search_;
  for (const std::uint32_t slot : edit.removed) {
    if (slot >= first_at_.size()) continue;
    for (std::uint32_t s = first_at_[slot]; s != kNoIndex; s = supports_[s].next_of_slot) {
      const std::uint32_t t = supports_[s].triangle;
      if (std::exchange(seen_[t], search_) != search_) affected_.push_back(t);
    }
  }
  if (answer_of_.size() < assigned.size()) answer_of_.resize(assigned.size(), kNoIndex);
  for (std::uint32_t i = 0; i < edit.answers.size(); ++i) answer_of_[edit.answers[i].point] = i;
  around_->look_at(mesh, edit);
  bool permitted = true;
  for (const std::uint32_t t : affected_) {
    used_.clear();
    if (prove_after(t, assigned, *around_)) {
      for (const std::uint32_t id : used_) anew_.emplace_back(t, id);
    } else if (tolerant) {
      given_up_.push_back(t);
    } else {
      permitted = false;
      break;
    }
  }
  for (const MeshEdit::Answer& a : edit.answers) answer_of_[a.point] = kNoIndex;
  return permitted;
}

bool ReferenceCover::prove_after(std::uint32_t triangle, const AssignedPoints& assigned,
                                 Around& around) {
  Piece whole;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t p = triangles_[triangle][i];
    const std::uint32_t a = answer_of_[p];
    double squared = 0;
    if (a == kNoIndex) {
      whole[i].near = assigned.owner(p);
      squared = assigned.squared_distance(p);
    } else {
      const MeshEdit::Answer& answer = around.edit().answers[a];
      whole[i].near = answer.added == kNoIndex ? answer.slot : kAdded | answer.added;
      squared = answer.squared_distance;
    }
    if (whole[i].near == kNoIndex || squared > squared_limit_) return false;
    whole[i].at = points_[p];
  }
  if (whole[0].near == whole[1].near && whole[1].near == whole[2].near) {
    use(whole[0].near);
    return true;
  }
  around.forget();
  for (std::uint32_t s = recalls_ ? first_of_[triangle] : kNoIndex; s != kNoIndex;
       s = supports_[s].next_of_triangle) {
    around.recall(supports_[s].slot);
  }
  return prove_piece(whole, around);
}

bool ReferenceCover::prove_piece(const Piece& whole, Around& around) {
  // The triangle that two of the corners are near to, if there is one.
  const std::uint32_t likely = whole[1].near == whole[2].near ? whole[1].near : whole[0].near;
  if (rests_on(whole, likely, around)) {
    use(likely);
    return true;
  }
  cuts_ = 0;
  const TrianglePlane plane({whole[0].at, whole[1].at, whole[2].at});
  if (follow(plane, likely, around)) return true;
  // A corner on a crease may be near to the sheet on the other side of it.
  const std::uint32_t middle = around.nearest((whole[0].at + whole[1].at + whole[2].at) / 3);
  if (middle != likely && middle != kNoIndex && follow(plane, middle, around)) return true;
  // No sheet begins under the middle, or a part of it could not be proven.
  used_.clear();
  cuts_ = 0;
  return cover(whole, around);
}

// For what an edit affects this would take too long.
bool ReferenceCover::prove_thoroughly(const Piece& whole, Around& around) {
  if (prove_piece(whole, around) || prove_parts(whole, around)) return true;
  used_.clear();
  cuts_elsewhere_ = true;
  const bool proven = prove_piece(whole, around) || prove_parts(whole, around);
  cuts_elsewhere_ = false;
  return proven;
}

bool ReferenceCover::prove_parts(const Piece& whole, Around& around) {
  std::vector<std::uint32_t> all;
  std::vector<std::pair<Piece, int>> left = {{whole, 0}};
  while (!left.empty()) {
    const auto [piece, halvings] = left.back();
    left.pop_back();
    used_.clear();
    if (prove_piece(piece, around)) {
      all.insert(all.end(), used_.begin(), used_.end());
      continue;
    }
    if (halvings == kMostHalvings) return false;
    Piece middles;  // opposite the corners
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &a = piece[(i + 1) % 3], &b = piece[(i + 2) % 3];
      middles[i] = labelled(0.5 * (a.at + b.at), {a.near, b.near}, around);
      if (middles[i].near == kNoIndex) return false;
    }
    left.emplace_back(middles, halvings + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      left.emplace_back(Piece{piece[i], middles[(i + 2) % 3], middles[(i + 1) % 3]}, halvings + 1);
    }
  }
  sort_once(all);
  used_ = std::move(all);
  return true;
}

bool ReferenceCover::follow(const TrianglePlane& plane, std::uint32_t from, Around& around) {
  const std::uint32_t start = walk_->under_centroid(plane, from, around);
  if (start == kNoIndex) return false;
  around.begin_visits();
  used_.clear();
  const Sheet sheet =
      walk_->follow_covering(plane, start, around.limit(), around,
                             [&](const std::vector<PlanarCorner>& part, std::uint32_t id) {
                               return part_within(plane, part, id, around);
                             });
  if (sheet != Sheet::kWithin) return false;
  for (const std::uint32_t id : around.visited()) use(id);
  return true;
}

// What is not within the limit of the sheet's own triangle is covered piece by piece.
bool ReferenceCover::part_within(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                                 std::uint32_t id, Around& around) {
  corners_.clear();
  bool within = true;
  for (const PlanarCorner& c : part) {
    corners_.push_back(labelled(plane.lift(c), {id}, around));
    if (corners_.back().near == kNoIndex) return false;
    within = within && corners_.back().near == id;
  }
  for (std::size_t i = 2; i < part.size() && !within; ++i) {
    if (!cover({corners_[0], corners_[i - 1], corners_[i]}, around)) return false;
  }
  return true;
}

bool ReferenceCover::rests_on(const Piece& piece, std::uint32_t id, const Around& around) const {
  return std::ranges::all_of(piece, [&](const Corner& corner) {
    return corner.near == id || around.squared_distance_to(corner.at, id) <= squared_limit_;
  });
}

void ReferenceCover::use(std::uint32_t id) {
  if (std::ranges::find(used_, id) == used_.end()) used_.push_back(id);
}

// Cuts the piece until each part rests on one triangle.
bool ReferenceCover::cover(const Piece& whole, Around& around) {
  pieces_.assign(1, whole);
  while (!pieces_.empty()) {
    const Piece piece = pieces_.back();
    pieces_.pop_back();
    const std::uint32_t a = piece[0].near, b = piece[1].near, c = piece[2].near;
    // The triangle that two of the corners are near to is tried first.
    const std::array<std::uint32_t, 3> likely = {b == c ? b : a, b == c ? a : b, c};
    bool rests = false;
    for (std::size_t i = 0; i < 3 && !rests; ++i) {
      if ((i > 0 && likely[i] == likely[0]) || (i == 2 && likely[2] == likely[1])) continue;
      rests = rests_on(piece, likely[i], around);
      if (rests) use(likely[i]);
    }
    if (rests) continue;
    if (++cuts_ > kMostCuts || !cut(piece, around)) return false;
  }
  return true;
}

// A point with a triangle within the limit of it, one of the likely ones if possible; kNoIndex
// where there is none.
ReferenceCover::Corner ReferenceCover::labelled(const Point& at,
                                                std::initializer_list<std::uint32_t> likely,
                                                Around& around) const {
  for (const std::uint32_t id : likely) {
    if (around.squared_distance_to(at, id) <= squared_limit_) return {at, id};
  }
  const std::uint32_t id = around.nearest(at);
  const bool within = id != kNoIndex && around.squared_distance_to(at, id) <= squared_limit_;
  return {at, within ? id : kNoIndex};
}

// Two triangles of the mesh that corners of the piece are near to, adjacent ones if possible.
ReferenceCover::Seam ReferenceCover::seam_under(const Piece& piece, const Around& around) {
  Seam seam;
  for (std::size_t i = 0; i < 3 && !seam.adjacent; ++i) {
    const std::uint32_t s = piece[i].near, t = piece[(i + 1) % 3].near;
    if (s == t) continue;
    seam.one = s;
    seam.other = t;
    std::size_t shared = 0;
    for (const std::uint32_t v : around.corners(s)) {
      if (has(around.corners(t), v) && shared < 2) seam.edge[shared++] = v;
    }
    seam.adjacent = shared == 2;
  }
  return seam;
}

// Of each corner, from the plane that halves the angle between two adjacent triangles: positive
// where it is on the other's side. Nothing where they are folded onto each other.
std::optional<std::array<double, 3>> ReferenceCover::sides_of_plane(const Piece& piece,
                                                                    const Seam& seam,
                                                                    const Around& around) {
  const std::array<Point, 3> s = around.points(seam.one), t = around.points(seam.other);
  const Point normals =
      (s[1] - s[0]).cross(s[2] - s[0]).normalized() + (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  if (!(normals.squaredNorm() > kLeastTurn)) return std::nullopt;
  const auto place = [&](std::uint32_t id, std::uint32_t v) {
    const Triangle& triangle = around.corners(id);
    const auto at = static_cast<std::size_t>(std::ranges::find(triangle, v) - triangle.begin());
    return (id == seam.one ? s : t)[at];
  };
  const Point from = place(seam.one, seam.edge[0]);
  Point across = (place(seam.one, seam.edge[1]) - from).cross(normals);
  const std::uint32_t apex = opposite(around.corners(seam.other), seam.edge[0], seam.edge[1]);
  if (across.dot(place(seam.other, apex) - from) < 0) across = -across;
  std::array<double, 3> side;
  for (std::size_t i = 0; i < 3; ++i) side[i] = across.dot(piece[i].at - from);
  return side;
}

// By the distances: positive where the other triangle is nearer.
std::array<double, 3> ReferenceCover::sides_by_distance(const Piece& piece, const Seam& seam,
                                                        const Around& around) {
  std::array<double, 3> side;
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = std::sqrt(around.squared_distance_to(piece[i].at, seam.one)) -
              std::sqrt(around.squared_distance_to(piece[i].at, seam.other));
  }
  return side;
}

// Cuts the piece between two triangles of the mesh that its corners are near to. If they share an
// edge, the cut is along the plane that halves the angle between them, else where their distances
// are equal. Corners that an earlier cut put onto that plane may be beyond the limit of one of the
// triangles, as it ends before them; cut there again the piece mostly stays as it is, and
// cuts_elsewhere_ cuts where the distances are equal.
bool ReferenceCover::cut(const Piece& piece, Around& around) {
  const Seam seam = seam_under(piece, around);
  if (seam.adjacent) {
    const std::optional<std::array<double, 3>> side = sides_of_plane(piece, seam, around);
    if (side && (!cuts_elsewhere_ || lone_of(*side) == 3 || separates(*side))) {
      return cut(piece, seam, *side, 0, around);
    }
  }
  return cut(piece, seam, sides_by_distance(piece, seam, around), kLeastPart, around);
}

bool ReferenceCover::cut(const Piece& piece, const Seam& seam, const std::array<double, 3>& side,
                         double least_part, Around& around) {
  const std::size_t lone = lone_of(side);
  if (lone == 3) return halve(piece, around);
  const auto between = [&](std::size_t i, std::size_t j, double share) {
    return Point(piece[i].at + share * (piece[j].at - piece[i].at));
  };
  const std::size_t i = (lone + 1) % 3, j = (lone + 2) % 3;
  const auto share = [&](std::size_t k) {
    return std::clamp(share_of(side, lone, k), least_part, 1 - least_part);
  };
  const Point x = between(lone, i, share(i)), y = between(lone, j, share(j));
  const bool lone_is_other = side[lone] > 0;
  const std::uint32_t here = lone_is_other ? seam.other : seam.one;
  const std::uint32_t there = lone_is_other ? seam.one : seam.other;
  const Corner x_here = labelled(x, {here, there}, around);
  const Corner y_here = labelled(y, {here, there}, around);
  const Corner x_there = labelled(x, {there, here}, around);
  const Corner y_there = labelled(y, {there, here}, around);
  if (x_here.near == kNoIndex || y_here.near == kNoIndex) return false;
  pieces_.push_back({piece[lone], x_here, y_here});
  if ((x - piece[j].at).squaredNorm() < (y - piece[i].at).squaredNorm()) {
    pieces_.push_back({x_there, piece[i], piece[j]});
    pieces_.push_back({x_there, piece[j], y_there});
  } else {
    pieces_.push_back({x_there, piece[i], y_there});
    pieces_.push_back({y_there, piece[i], piece[j]});
  }
  return true;
}

// At its longest side.
bool ReferenceCover::halve(const Piece& piece, Around& around) {
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = (piece[(i + 1) % 3].at - piece[i].at).squaredNorm();
    if (squared <= length) continue;
    length = squared;
    longest = i;
  }
  const Corner &a = piece[longest], &b = piece[(longest + 1) % 3], &c = piece[(longest + 2) % 3];
  const Corner middle = labelled(0.5 * (a.at + b.at), {a.near, b.near}, around);
  if (middle.near == kNoIndex) return false;
  pieces_.push_back({a, middle, c});
  pieces_.push_back({middle, b, c});
  return true;
}

void ReferenceCover::add_support(std::uint32_t triangle, std::uint32_t slot) {
  std::uint32_t s = free_;
  if (s == kNoIndex) {
    s = static_cast<std::uint32_t>(supports_.size());
    supports_.emplace_back();
  } else {
    free_ = supports_[s].next_of_triangle;
  }
  supports_[s] = {triangle, slot, first_of_[triangle], first_at_[slot], kNoIndex};
  if (first_at_[slot] != kNoIndex) supports_[first_at_[slot]].previous_of_slot = s;
  first_at_[slot] = s;
  first_of_[triangle] = s;
}

void ReferenceCover::drop_supports(std::uint32_t triangle) {
  for (std::uint32_t s = first_of_[triangle]; s != kNoIndex;) {
    Support& support = supports_[s];
    (support.previous_of_slot == kNoIndex ? first_at_[support.slot]
                                          : supports_[support.previous_of_slot].next_of_slot) =
        support.next_of_slot;
    if (support.next_of_slot != kNoIndex) {
      supports_[support.next_of_slot].previous_of_slot = support.previous_of_slot;
    }
    const std::uint32_t next = support.next_of_triangle;
    support.next_of_triangle = free_;
    free_ = s;
    s = next;
  }
  first_of_[triangle] = kNoIndex;
}

void ReferenceCover::apply(std::span<const std::uint32_t> placed, Undo* undo) {
  for (const std::uint32_t t : affected_) {
    if (undo != nullptr) {
      undo->triangles.push_back(t);
      for (std::uint32_t s = first_of_[t]; s != kNoIndex; s = supports_[s].next_of_triangle) {
        undo->supports.emplace_back(t, supports_[s].slot);
      }
    }
    drop_supports(t);
  }
  for (const auto& [t, id] : anew_) {
    const std::uint32_t slot = (id & kAdded) != 0 ? placed[id & ~kAdded] : id;
    if (slot >= first_at_.size()) first_at_.resize(slot + 1, kNoIndex);
    add_support(t, slot);
  }
  unproven_ += given_up_.size();
  affected_.clear();
  anew_.clear();
}

void ReferenceCover::undo(const Undo& undo) {
  for (const std::uint32_t t : undo.triangles) {
    if (!proven(t)) --unproven_;
    drop_supports(t);
  }
  for (const auto& [t, slot] : undo.supports) add_support(t, slot);
}

}  // namespace emax
