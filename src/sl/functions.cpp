#include "sl/functions.h"

#include <algorithm>

#include <fmt/format.h>

namespace shaderx::sl {

bool isGeometric(Type t) { return t == Type::Vector3 || t == Type::Point || t == Type::Normal; }

int conversionRank(Type from, Type to) {
    if (from == to) return 0;
    bool isNumber = from == Type::Integer || from == Type::Float;
    if (from == Type::Integer && to == Type::Float) return 1;
    if (isGeometric(from) && isGeometric(to)) return 1;
    if (isNumber && ir::isFloatVector(to)) return 2;
    // What a material is made of stands for it.
    if (to == Type::Material && (from == Type::SurfaceShader || from == Type::VolumeShader)) return 1;
    return -1;
}

Type meet(Type a, Type b) {
    if (!ir::isNumeric(a) || !ir::isNumeric(b)) return Type::Void;
    if (a == b) return a;
    if (ir::isScalar(a) && ir::isScalar(b)) return Type::Float;
    if (ir::isScalar(a)) return b;
    if (ir::isScalar(b)) return a;
    return isGeometric(a) && isGeometric(b) ? Type::Vector3 : Type::Void;
}

std::string typeList(std::span<const Type> types) {
    std::string text = "(";
    for (Type t : types) {
        if (text.size() > 1) text += ", ";
        text += ir::info(t).name;
    }
    return text += ')';
}

std::string signatureText(const NameTable& names, const Signature& s) {
    std::string text = fmt::format("{} {}(", ir::info(s.result).name, names.text(s.plainName));
    std::string_view between;
    for (const ir::Param& p : s.params) {
        text += fmt::format("{}{} {}", between, ir::info(p.type).name, names.text(p.name));
        between = ", ";
    }
    for (const ir::Param& p : s.outputs) {
        text += fmt::format("{}output {} {}", between, ir::info(p.type).name, names.text(p.name));
        between = ", ";
    }
    return text += ')';
}

FunctionTable::FunctionTable(std::span<const Signature> made, std::span<const Signature> known, bool withIndex)
    : made_(made), known_(known), hasIndex_(withIndex) {
    if (!withIndex) return;
    for (std::uint32_t i = 0; i < made_.size() + known_.size(); i++) byName_[at(i).plainName].push_back(i);
}

std::vector<std::uint32_t> FunctionTable::called(Name plainName) const {
    std::vector<std::uint32_t> found;
    if (hasIndex_) {
        auto entry = byName_.find(plainName);
        return entry == byName_.end() ? found : entry->second;
    }
    for (std::uint32_t i = 0; i < made_.size() + known_.size(); i++)
        if (at(i).plainName == plainName) found.push_back(i);
    return found;
}

bool FunctionTable::has(Name plainName) const {
    return hasIndex_ ? byName_.count(plainName) != 0 : !called(plainName).empty();
}

std::vector<std::string_view> FunctionTable::plainNames(const NameTable& names) const {
    std::vector<std::string_view> all;
    for (std::uint32_t i = 0; i < made_.size() + known_.size(); i++) all.push_back(names.text(at(i).plainName));
    return all;
}

// Conversions in the upper part, their ranks in the lower; none where the arguments do not fit.
static std::optional<std::uint32_t> cost(const Signature& s, std::span<const ArgumentType> arguments) {
    if (s.params.size() + s.outputs.size() != arguments.size()) return {};
    std::uint32_t total = 0;
    for (std::size_t k = 0; k < arguments.size(); k++) {
        bool isOutput = k >= s.params.size();
        if (isOutput && !arguments[k].isPlace) return {};
        int rank = isOutput ? conversionRank(s.outputs[k - s.params.size()].type, arguments[k].type)
                            : conversionRank(arguments[k].type, s.params[k].type);
        if (rank < 0) return {};
        if (rank > 0) total += 0x10000u + static_cast<std::uint32_t>(rank);
    }
    return total;
}

Choice FunctionTable::choose(Name plainName, std::span<const ArgumentType> arguments) const {
    Choice c;
    std::vector<std::uint32_t> all = called(plainName);
    std::uint32_t least = 0;
    for (std::uint32_t i : all) {
        auto here = cost(at(i), arguments);
        if (!here || (c.chosen && *here > least)) continue;
        if (!c.chosen || *here < least) c.candidates.clear();
        c.candidates.push_back(&at(i));
        c.chosen = &at(i);
        c.index = i < made_.size() ? i : kKnown;
        least = *here;
    }
    c.isAmbiguous = c.candidates.size() > 1;
    if (c.isAmbiguous) c.chosen = nullptr;
    if (c.candidates.empty())
        for (std::uint32_t i : all) c.candidates.push_back(&at(i));
    return c;
}

bool FunctionTable::mayWrite(Name plainName, std::size_t count, std::size_t k) const {
    for (std::uint32_t i : called(plainName)) {
        const Signature& s = at(i);
        if (s.params.size() + s.outputs.size() == count && k >= s.params.size()) return true;
    }
    return false;
}

std::vector<std::uint32_t> neededFirst(const std::vector<std::vector<std::uint32_t>>& edges,
                                       std::vector<std::vector<std::uint32_t>>& cycles) {
    enum class Mark : std::uint8_t { New, Open, Done };
    struct Frame {
        std::uint32_t node;
        std::size_t next = 0;
    };
    std::vector<Mark> marks(edges.size(), Mark::New);
    std::vector<std::uint32_t> order;
    std::vector<Frame> stack;
    for (std::uint32_t root = 0; root < edges.size(); root++) {
        if (marks[root] != Mark::New) continue;
        stack.push_back({root});
        marks[root] = Mark::Open;
        while (!stack.empty()) {
            Frame& top = stack.back();
            if (top.next == edges[top.node].size()) {
                marks[top.node] = Mark::Done;
                order.push_back(top.node);
                stack.pop_back();
                continue;
            }
            std::uint32_t to = edges[top.node][top.next++];
            if (marks[to] == Mark::Open) {
                std::vector<std::uint32_t> cycle;
                auto at = std::find_if(stack.begin(), stack.end(), [&](const Frame& f) { return f.node == to; });
                for (; at != stack.end(); at++) cycle.push_back(at->node);
                if (cycles.size() < 20) cycles.push_back(std::move(cycle));  // enough to tell
            } else if (marks[to] == Mark::New) {
                marks[to] = Mark::Open;
                stack.push_back({to});
            }
        }
    }
    return order;
}

}  // namespace shaderx::sl
