// The scalars of a value: a scalar itself, or those of an aggregate's fields, in their order.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace emax {

// Converts to anything; only for asking what a braced initialiser takes.
struct AnyField {
  template <class Field>
  operator Field() const;  // NOLINT(google-explicit-constructor)
};

template <class Value, std::size_t... i>
constexpr bool takes_fields(std::index_sequence<i...>) {
  return requires { Value{(static_cast<void>(i), AnyField{})...}; };
}

constexpr std::size_t kMostFields = 12;

template <class Value, std::size_t count = kMostFields + 1>
constexpr std::size_t field_count() {
  if constexpr (count == 0 || takes_fields<Value>(std::make_index_sequence<count>())) {
    return count;
  } else {
    return field_count<Value, count - 1>();
  }
}

template <class Visit, class... Values>
void for_each_leaf(const Visit& visit, Values&... values);

template <class Visit, class Value>
void visit_leaves(const Visit& visit, Value& value) {
  if constexpr (!std::is_aggregate_v<std::remove_const_t<Value>>) {
    visit(value);
  } else {
    constexpr std::size_t kFields = field_count<std::remove_const_t<Value>>();
    static_assert(kFields >= 1 && kFields <= kMostFields, "an aggregate has 1 to 12 fields");
#define EMAX_FIELDS(count, ...)        \
  if constexpr (kFields == (count)) {  \
    auto& [__VA_ARGS__] = value;       \
    for_each_leaf(visit, __VA_ARGS__); \
  }
    EMAX_FIELDS(1, a)
    EMAX_FIELDS(2, a, b)
    EMAX_FIELDS(3, a, b, c)
    EMAX_FIELDS(4, a, b, c, d)
    EMAX_FIELDS(5, a, b, c, d, e)
    EMAX_FIELDS(6, a, b, c, d, e, f)
    EMAX_FIELDS(7, a, b, c, d, e, f, g)
    EMAX_FIELDS(8, a, b, c, d, e, f, g, h)
    EMAX_FIELDS(9, a, b, c, d, e, f, g, h, i)
    EMAX_FIELDS(10, a, b, c, d, e, f, g, h, i, j)
    EMAX_FIELDS(11, a, b, c, d, e, f, g, h, i, j, k)
    EMAX_FIELDS(12, a, b, c, d, e, f, g, h, i, j, k, l)
#undef EMAX_FIELDS
  }
}

// visit(scalar) for every scalar of every value.
template <class Visit, class... Values>
void for_each_leaf(const Visit& visit, Values&... values) {
  (visit_leaves(visit, values), ...);
}

}  // namespace emax
