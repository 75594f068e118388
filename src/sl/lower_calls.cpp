// Lowering: calls of functions, and values made from parts.
#include <algorithm>

#include "sl/lower_state.h"
#include "sl/parser.h"

namespace shaderx::sl {

// Values of the arguments, in order. One that a function might write keeps what the variable is now.
std::vector<Lowering::Argument> Lowering::arguments(const Node& n, bool mayWrite) {
    std::vector<Argument> args(n.children.count);
    for (std::uint32_t k = 0; k < n.children.count; k++) {
        Argument& a = args[k];
        a.node = tree.child(n, k);
        if (mayWrite && program.functions.mayWrite(n.name, n.children.count, k)) a.place = placeOf(a.node, false);
        if (a.place) {
            a.before = variables[a.place->variable];
            a.type = placeType(*a.place);
        } else {
            a.value = expression(a.node);
            a.type = a.value ? b.type(a.value) : Type::Void;
        }
    }
    return args;
}

ExprId Lowering::argumentValue(const Argument& a) {
    return a.place ? read(*a.place, a.before, tree[a.node].offset) : a.value;
}

// After a call that is in error: what it may have written has no further messages.
void Lowering::forgive(const std::vector<Argument>& args) {
    for (const Argument& a : args)
        if (a.place) set(a.place->variable, {}, allBits(variables[a.place->variable].type));
}

ExprId Lowering::call(const Node& n, bool isStatement) {
    bool isUser = program.functions.has(n.name);
    std::string_view word = text(n.name);
    if (!isUser && (word == "attribute" || word == "geomprop")) return geometricAttribute(n);
    if (!isUser && structNamed(n.name)) return makeStruct(n);
    std::vector<Argument> args = arguments(n, isUser);
    std::vector<ArgumentType> types;
    for (const Argument& a : args) types.push_back({a.type, a.place.has_value()});
    auto isWrong = [](const Argument& a) { return a.type == Type::Void; };
    if (std::any_of(args.begin(), args.end(), isWrong)) {
        forgive(args);
        return {};
    }
    Choice choice = program.functions.choose(n.name, types);
    if (choice.chosen) return userCall(n, choice, args, isStatement);
    auto builtins = builtinsCalled(word);
    if (builtins.empty() || choice.isAmbiguous) {
        noFunction(n, choice, args);
        forgive(args);
        return {};
    }
    std::vector<ExprId> values;
    for (const Argument& a : args) values.push_back(argumentValue(a));
    if (std::find(values.begin(), values.end(), ExprId()) != values.end()) return {};
    if (isStatement) report.error(n.offset, "no-effect", fmt::format("'{}' has no effect on its own", word));
    for (const Builtin& f : builtins)
        if (static_cast<std::size_t>(f.arguments) == values.size())
            if (ExprId made = builtin(f, values)) return made;
    std::vector<Type> given;
    for (const Argument& a : args) given.push_back(a.type);
    report.error(n.offset, "no-overload", fmt::format("'{}' does not take {}", word, typeList(given))).hint =
        fmt::format("it is {}", builtins[0].use);
    return {};
}

ExprId Lowering::userCall(const Node& n, const Choice& choice, const std::vector<Argument>& args, bool isStatement) {
    const Signature& s = *choice.chosen;
    std::vector<ExprId> values;
    for (std::size_t k = 0; k < s.params.size(); k++) {
        ExprId value = argumentValue(args[k]);
        values.push_back(value ? b.convert(value, s.params[k].type) : value);
    }
    if (!isStatement && s.result == Type::Void) {
        report.error(n.offset, "type-mismatch", fmt::format("{} returns no value", quoted(text(n.name)))).hint =
            "call it as a statement; it writes its outputs";
        values.push_back({});
    }
    if (calls && choice.index != FunctionTable::kKnown) calls->push_back({choice.index, n.offset});
    if (std::find(values.begin(), values.end(), ExprId()) != values.end()) {
        forgive(args);
        return {};
    }
    bool hasResult = s.result != Type::Void;
    std::size_t results = s.outputs.size() + (hasResult ? 1 : 0);
    Type single = hasResult ? s.result : s.outputs.empty() ? Type::Tuple : s.outputs[0].type;
    ExprId made = b.call(s.name, results == 1 ? single : Type::Tuple, values);
    auto result = [&](std::uint32_t k, Type t) { return results == 1 ? made : b.result(made, k, t); };
    for (std::uint32_t k = 0; k < s.outputs.size(); k++) {
        const Place& place = *args[s.params.size() + k].place;
        assign(place, b.convert(result(k + hasResult, s.outputs[k].type), placeType(place)));
    }
    return hasResult ? result(0, s.result) : ExprId();
}

// Says why no function was chosen.
void Lowering::noFunction(const Node& n, const Choice& choice, const std::vector<Argument>& args) {
    std::string word = quoted(text(n.name));
    std::vector<Type> types;
    for (const Argument& a : args) types.push_back(a.type);
    constexpr std::size_t kTold = 8;
    if (program.isIncomplete && !choice.isAmbiguous) {
        report.silent();
    } else if (choice.candidates.empty()) {
        Diagnostic& d = report.error(n.offset, "unknown-function", fmt::format("unknown function {}", word));
        std::vector<std::string_view> known = program.functions.plainNames(*program.module.names);
        std::vector<std::string_view> own = builtinNames();
        known.insert(known.end(), own.begin(), own.end());
        std::string_view near = text(n.name).size() <= 64 ? nearest(text(n.name), known) : std::string_view();
        if (!near.empty()) d.hint = fmt::format("did you mean '{}'?", near);
    } else {
        Diagnostic& d =
            choice.isAmbiguous
                ? report.error(n.offset, "ambiguous-call",
                               fmt::format("several {} take {} equally well", word, typeList(types)))
                : report.error(n.offset, "no-overload", fmt::format("no {} takes {}", word, typeList(types)));
        for (std::size_t k = 0; k < choice.candidates.size() && k < kTold; k++)
            d.notes.push_back({{}, signatureText(*program.module.names, *choice.candidates[k])});
    }
}

const ir::StructType* Lowering::structNamed(Name name) const {
    for (const ir::StructType& s : program.module.structs)
        if (s.name == name) return &s;
    return nullptr;
}

// A structure by its name, from a value for each of its members.
ExprId Lowering::makeStruct(const Node& n) {
    const ir::StructType& s = *structNamed(n.name);
    const auto index = static_cast<std::size_t>(&s - program.module.structs.data());
    std::vector<ExprId> parts;
    for (std::uint32_t k = 0; k < n.children.count; k++) {
        const ExprId given = expression(tree.child(n, k));
        if (!given) return {};
        const ExprId part = k < s.members.size() ? b.convert(given, s.members[k].type) : ExprId();
        if (part) parts.push_back(part);
    }
    if (parts.size() == s.members.size() && parts.size() == n.children.count)
        return b.emit(Op::Make, ir::structType(index), parts);
    report.error(n.offset, "no-overload", fmt::format("'{}' takes a value for each of its members", text(n.name)));
    return {};
}

// attribute("texcoord_0", vector2): the attribute of that very name; geomprop(text, vector2): the one that the host
// calls geomprop_ and what the text says.
ExprId Lowering::geometricAttribute(const Node& n) {
    bool isProperty = text(n.name) == "geomprop";
    bool isPair = n.children.count == 2;
    const Node* type = isPair ? &tree[tree.child(n, 1)] : nullptr;
    Type t = type && (type->kind == NodeKind::Name) ? typeCalled(text(type->name)) : Type::Void;
    ExprId named = isPair ? expression(tree.child(n, 0)) : ExprId();
    if (isPair && !named) return {};
    bool isText = named && b.type(named) == Type::String && (isProperty || b.function().isConstant(named));
    if (isText && ir::componentCount(t) > 0)
        return isProperty ? b.emit(Op::GeomProp, t, {named}) : b.attribute(Name(b.function()[named].payload), t);
    report
        .error(n.offset, "no-overload",
               fmt::format("'{}' takes a {} and the name of a type of numbers", text(n.name),
                           isProperty ? "string" : "constant string"))
        .hint = fmt::format("{}(\"uv\", vector2)", text(n.name));
    return {};
}

// ---- type(parts) ----

ExprId Lowering::construct(const Node& n) {
    std::vector<ExprId> args;
    std::vector<Type> types;
    for (std::uint32_t k = 0; k < n.children.count; k++) {
        args.push_back(expression(tree.child(n, k)));
        if (args.back()) types.push_back(b.type(args.back()));
    }
    if (types.size() != args.size()) return {};
    ExprId made;
    bool isSingleScalar = args.size() == 1 && ir::isScalar(types[0]);
    if (ir::isClosure(n.type) && args.empty())
        made = b.null(n.type);
    else if (ir::isScalar(n.type) && isSingleScalar)
        made = b.convert(args[0], n.type);
    else if (ir::isVector(n.type))
        made = constructVector(n.type, args);
    else if (ir::isMatrix(n.type))
        made = constructMatrix(n.type, args);
    if (made) return made;
    std::string_view word = ir::info(n.type).name;
    Diagnostic& d =
        report.error(n.offset, "no-overload", fmt::format("{} cannot be made from {}", word, typeList(types)));
    if (ir::isVector(n.type))
        d.hint = fmt::format("it has {} components; take some of a longer one as 'v.xy'", ir::componentCount(n.type));
    if (ir::isMatrix(n.type)) d.hint = "a matrix is made from its columns, or from all its numbers column by column";
    return {};
}

ExprId Lowering::constructVector(Type type, const std::vector<ExprId>& args) {
    int components = 0;
    std::vector<ExprId> parts;
    for (ExprId a : args) {
        Type t = b.type(a);
        if (!ir::isScalar(t) && !ir::isFloatVector(t)) return {};
        components += ir::componentCount(t);
        parts.push_back(ir::isScalar(t) ? b.convert(a, Type::Float) : a);
    }
    if (args.size() == 1 && (components == 1 || components == ir::componentCount(type)))
        return b.convert(parts[0], type);
    return components == ir::componentCount(type) ? b.make(type, parts) : ExprId();
}

ExprId Lowering::constructMatrix(Type type, const std::vector<ExprId>& args) {
    int n = ir::info(type).rows;
    Type column = ir::floatVector(n);
    auto count = static_cast<std::size_t>(n);
    std::vector<ExprId> columns;
    auto isAll = [&](auto holds) {
        return std::all_of(args.begin(), args.end(), [&](ExprId a) { return holds(b.type(a)); });
    };
    if (args.size() == count && isAll([&](Type t) { return ir::isFloatVector(t) && ir::componentCount(t) == n; })) {
        for (ExprId a : args) columns.push_back(b.convert(a, column));
    } else if (args.size() == count * count && isAll([](Type t) { return ir::isScalar(t); })) {
        for (std::size_t c = 0; c < count; c++) {
            std::vector<ExprId> parts;
            for (std::size_t r = 0; r < count; r++) parts.push_back(b.convert(args[c * count + r], Type::Float));
            columns.push_back(b.make(column, parts));
        }
    } else if (args.size() == 1 && ir::isScalar(b.type(args[0]))) {
        // The number on the diagonal.
        ExprId zero = b.number(0), value = b.convert(args[0], Type::Float);
        for (int c = 0; c < n; c++) {
            std::vector<ExprId> parts(count, zero);
            parts[static_cast<std::size_t>(c)] = value;
            columns.push_back(b.make(column, parts));
        }
    } else if (args.size() == 1 && ir::isMatrix(b.type(args[0]))) {
        if (b.type(args[0]) == type) return args[0];
        for (int c = 0; c < n; c++) {
            bool isBeyond = c == ir::info(b.type(args[0])).columns;  // a 4x4 matrix from a 3x3 one
            ExprId from = isBeyond ? ExprId() : component(args[0], c);
            if (isBeyond)
                columns.push_back(b.constant(Type::Vector4, {0, 0, 0, 1}));
            else if (n == 3)
                columns.push_back(b.swizzle(from, ir::swizzleMask(3, 0, 1, 2)));
            else
                columns.push_back(b.make(column, {from, b.number(0)}));
        }
    } else {
        return {};
    }
    return b.make(type, columns);
}

}  // namespace shaderx::sl
