// Conversions between types, and the choice among the functions of one name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "sl/compile.h"

namespace shaderx::sl {

using ir::Type;

// True for the three types of geometry that mix in arithmetic: vector3, point, normal.
bool isGeometric(Type t);

// How far an implicit conversion goes: 0 for none needed, 1 from integer to float or among vector3, point and normal,
// 2 from a number to a vector; -1 where there is none.
int conversionRank(Type from, Type to);

// The type of a componentwise operation on two numbers, vectors or matrices, or Void where they do not meet.
Type meet(Type a, Type b);

// "(float, color3)"
std::string typeList(std::span<const Type> types);
// "float fresnel(float cosine, output color3 tint)"
std::string signatureText(const NameTable& names, const Signature& s);

// An argument of a call as far as the choice needs it.
struct ArgumentType {
    Type type = Type::Void;
    bool isPlace = false;  // something that an output can be written to
};

struct Choice {
    const Signature* chosen = nullptr;
    std::uint32_t index = 0;                   // of the chosen one in `made`, or kKnown
    std::vector<const Signature*> candidates;  // all of the name where none fits; those that fit best where several do
    bool isAmbiguous = false;
};

// The functions under compilation and those known from libraries.
class FunctionTable {
  public:
    static constexpr std::uint32_t kKnown = 0xffffffffu;
    // Both lists must not change while the table is in use. An index by name pays from some dozens of questions on.
    FunctionTable(std::span<const Signature> made, std::span<const Signature> known, bool withIndex);

    bool has(Name plainName) const;
    std::vector<std::string_view> plainNames(const NameTable& names) const;
    // The function that fits exactly, else the one with fewest conversions, else with the shortest ones.
    Choice choose(Name plainName, std::span<const ArgumentType> arguments) const;
    // Whether some function of the name with `count` arguments writes the k-th.
    bool mayWrite(Name plainName, std::size_t count, std::size_t k) const;

  private:
    const Signature& at(std::uint32_t i) const { return i < made_.size() ? made_[i] : known_[i - made_.size()]; }

    std::vector<std::uint32_t> called(Name plainName) const;

    std::span<const Signature> made_, known_;
    bool hasIndex_;
    std::unordered_map<Name, std::vector<std::uint32_t>> byName_;  // made_, then known_
};

// Orders numbers 0 … edges.size() - 1 such that what a number needs stands before it. `cycles`
// receives the cycles met on the way, each as the numbers along it.
std::vector<std::uint32_t> neededFirst(const std::vector<std::vector<std::uint32_t>>& edges,
                                       std::vector<std::vector<std::uint32_t>>& cycles);

}  // namespace shaderx::sl
