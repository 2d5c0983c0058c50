#pragma once

#include <emax/genocop.h>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace emax {

// A gene of the chromosome {P_R, P_D} (paper, section 3) with what people read of it. Its name is
// unique in its chain, e.g. "gp3.mu"; Gene::only_with holds a position in the same list.
struct Parameter : Gene {
  double standard = 0;                  // where no search is made, and where a search begins
  std::optional<double> fixed;          // not searched: always this value
  std::string meaning;                  // one line with the unit, shown in the configuration file
  std::vector<std::string> categories;  // of a categorical one: the names of 0, 1, ...

  bool operator==(const Parameter&) const = default;
};
using Parameters = std::vector<Parameter>;

// A parameter as a constant of the program, by which its value is asked for. T is double, int, bool
// or an enumeration, whose enumerators 0, 1, ... are the categories.
template <typename T>
struct ParameterKey {
  std::string_view name;
  T lower, upper;  // domain, both ends included
  T standard;
  std::string_view meaning;
  std::span<const std::string_view> categories = {};  // of an enumeration
  bool searched = true;  // false: fixed unless a configuration gives it a domain, because a search
                         // over it gains nothing

  constexpr ParameterKey with_standard(T other) const {
    ParameterKey key = *this;
    key.standard = other;
    return key;
  }

  Parameter parameter() const {
    Parameter p;
    p.name = name;
    p.kind = std::is_enum_v<T>             ? Gene::Kind::kCategorical
             : std::is_floating_point_v<T> ? Gene::Kind::kContinuous
                                           : Gene::Kind::kInteger;
    p.lower = static_cast<double>(lower);
    p.upper = static_cast<double>(upper);
    p.standard = static_cast<double>(standard);
    if (!searched) p.fixed = p.standard;
    p.meaning = meaning;
    p.categories.assign(categories.begin(), categories.end());
    return p;
  }
};

template <typename... T>
Parameters parameters_of(const ParameterKey<T>&... keys) {
  return {keys.parameter()...};
}

// Values of parameters. Asked for by key, so that a mistyped name does not compile.
class ParameterValues {
 public:
  using ByName = std::map<std::string, double, std::less<>>;

  ParameterValues() = default;
  explicit ParameterValues(ByName values) : values_(std::move(values)) {}
  // The standard value of each.
  explicit ParameterValues(std::span<const Parameter> parameters) {
    for (const Parameter& p : parameters) values_[p.name] = p.standard;
  }

  // Throws Error when it has no value.
  template <typename T>
  T at(const ParameterKey<T>& key) const {
    return static_cast<T>(value(key.name));
  }
  template <typename T>
  std::optional<T> find(const ParameterKey<T>& key) const {
    return contains(key) ? std::optional(at(key)) : std::nullopt;
  }
  template <typename T>
  bool contains(const ParameterKey<T>& key) const {
    return values_.contains(key.name);
  }
  template <typename T>
  void set(const ParameterKey<T>& key, std::type_identity_t<T> value) {
    values_.insert_or_assign(std::string(key.name), static_cast<double>(value));
  }

  // For whoever treats all of them alike: genes, messages, files. Whole numbers are whole doubles.
  const ByName& by_name() const { return values_; }
  ByName& by_name() { return values_; }
  // Throws Error when one of them has no value.
  void require(std::span<const Parameter> parameters) const;

  auto operator<=>(const ParameterValues&) const = default;

 private:
  double value(std::string_view name) const;

  ByName values_;
};

}  // namespace emax
