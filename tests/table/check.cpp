#include "table/check.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <random>
#include <unordered_set>

#include <fmt/format.h>

#include "base/numbers.h"
#include "ir/builder.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/specialise.h"
#include "passes/stages.h"
#include "table/world.h"
#include "targets/glsl/glsl.h"
#include "targets/glsl/names.h"
#include "targets/glsl/printer.h"

namespace shaderx::table {

using namespace ir;

namespace {

constexpr std::string_view kInputs = "table_inputs", kWhich = "table_which", kPlace = "table_place";
constexpr std::size_t kMostExprs =
    900;  // of one shader, all functions together: drivers take more than twice for twice
constexpr int kMoves = 4,
              kMoreMoves = 60;  // of the inputs, by up to 2 ulp; more of them before a value counts as wrong

// Functions of one module for another.
struct Forward final : FunctionSource {
    explicit Forward(const Module& from) : module(from) {}
    const Function* find(Name name) override { return module.find(name); }
    const LeafInfo* findLeaf(Name name) override { return module.leaf(name); }
    const Module& module;
};

// The values that a parameter has in each pixel; those of equal kind, domain and place among the parameters are shared.
struct Column {
    Scalar scalar;
    int components;
    std::size_t ordinal;
    Domain domain;
    std::vector<Value> values;
    int texels() const { return components > 4 ? (components == 9 ? 3 : 4) : 1; }
};

float drawNumber(const Domain& d, std::mt19937& random) {
    if (!d.edges.empty() && random() % 4 == 0) return d.edges[random() % d.edges.size()];
    return d.low + (d.high - d.low) * static_cast<float>(random() % 65536) / 65535.0f;
}

std::uint32_t drawWord(Scalar scalar, const Domain& d, std::mt19937& random) {
    switch (scalar) {
        case Scalar::Boolean:
            return random() % 2;
        case Scalar::Integer:
            if (d.isAnyInteger && random() % 4) return static_cast<std::uint32_t>(random());
            if (d.isAnyInteger && random() % 4 == 0) return random() % 2 ? 0x80000000u : 0x7fffffffu;
            return static_cast<std::uint32_t>(static_cast<int>(std::lround(drawNumber(d, random))));
        case Scalar::Float:
            return std::bit_cast<std::uint32_t>(drawNumber(d, random));
        case Scalar::None:
            break;
    }
    return 0;
}

void fill(Column& column) {
    std::mt19937 random(
        static_cast<std::uint32_t>(column.ordinal * 977 + static_cast<std::size_t>(column.components) * 31 + 5));
    for (int p = 0; p < kPixels; p++) {
        Value v;
        const bool same = random() % 8 == 0;
        for (int i = 0; i < column.components; i++)
            v.words[i] = same && i ? v.words[0] : drawWord(column.scalar, column.domain, random);
        if (column.domain.cone > 0) {
            const float angle = v.f(0), tilt = column.domain.cone * std::fabs(v.f(1)) / column.domain.high,
                        size = std::sqrt(1 + tilt * tilt);
            v.set(0, std::cos(angle) * tilt / size);
            v.set(1, std::sin(angle) * tilt / size);
            v.set(2, 1 / size);
        }
        column.values.push_back(v);
    }
}

// A number by up to 2 units in its last place.
float moved(float v, std::mt19937& random) {
    const int by = static_cast<int>(random() % 5) - 2;
    if (!std::isfinite(v)) return v;
    if (v == 0) return static_cast<float>(by) * std::numeric_limits<float>::min();
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(v) + static_cast<std::uint32_t>(by));
}

bool isTranscendental(Op op) {
    switch (op) {
        case Op::Pow:
        case Op::Atan2:
        case Op::Exp:
        case Op::Exp2:
        case Op::Log:
        case Op::Log2:
        case Op::Sin:
        case Op::Cos:
        case Op::Tan:
        case Op::Asin:
        case Op::Acos:
        case Op::Atan:
        case Op::TextureLevel:
        case Op::TextureGrad:
            return true;
        default:
            return false;  // arithmetic
    }
}

std::string textOf(const Value& v) {
    std::string out;
    for (int i = 0; i < componentCount(v.type); i++)
        out += (i ? " " : "") + (info(v.type).scalar == Scalar::Float ? formatFloat(v.f(i)) : std::to_string(v.i(i)));
    return fmt::format("{}({})", info(v.type).name, out);
}

double numberOf(const Value& v, int i) {
    return info(v.type).scalar == Scalar::Float ? static_cast<double>(v.f(i)) : static_cast<double>(v.i(i));
}

// Four numbers of what the driver computes, per subject: results one after the other, integers as two halves.
struct Slots {
    Builder& b;
    std::vector<ExprId> pending = {}, full = {};

    void put(ExprId number) {
        pending.push_back(number);
        if (pending.size() == 4) flush();
    }
    void flush() {
        if (pending.empty()) return;
        while (pending.size() < 4) pending.push_back(b.number(0));
        full.push_back(b.make(Type::Vector4, pending));
        pending.clear();
    }
    void putValue(ExprId value) {
        const Type type = b.type(value);
        if (info(type).scalar == Scalar::Boolean) return put(b.convert(value, Type::Float));
        if (info(type).scalar == Scalar::Integer) {
            put(b.convert(b.op(Op::ShiftRightLogical, {value, b.integer(16)}), Type::Float));
            return put(b.convert(b.op(Op::BitAnd, {value, b.integer(65535)}), Type::Float));
        }
        for (int c = 0; c < info(type).columns; c++) {
            ExprId column = isMatrix(type) ? b.swizzle(value, static_cast<std::uint32_t>(c)) : value;
            for (int r = 0; r < info(type).rows; r++) put(isScalar(type) ? column : b.component(column, r));
        }
    }
};

std::size_t floatsOf(const Function& f) {
    std::size_t n = 0;
    for (const ResultValue& r : f.results)
        n += static_cast<std::size_t>(componentCount(r.type)) * (info(r.type).scalar == Scalar::Integer ? 2 : 1);
    return n;
}

}  // namespace

bool isSame(const Domain& a, const Domain& b) {
    auto same = [](float x, float y) { return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y); };
    return a.low == b.low && a.high == b.high && a.cone == b.cone && a.isAnyInteger == b.isAnyInteger &&
           std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), same);
}

// The call graph, each function once.
static void forCallees(const Module& module, const Function& f, const std::function<void(const Function&)>& visit) {
    std::vector<const Function*> todo{&f};
    std::unordered_set<const Function*> seen{&f};
    while (!todo.empty()) {
        const Function* g = todo.back();
        todo.pop_back();
        visit(*g);
        for (const Expr& e : g->exprs)
            if (const Function* callee = e.op == Op::Call ? module.find(Name(e.payload)) : nullptr)
                if (seen.insert(callee).second) todo.push_back(callee);
    }
}

bool anyOperation(const Module& module, const Function& f,
                  const std::function<bool(const Function&, const Expr&)>& test) {
    bool found = false;
    forCallees(module, f, [&](const Function& g) {
        const std::vector<bool> live = reachable(g);
        for (std::size_t i = 0; i < g.exprs.size(); i++) found = found || (live[i] && test(g, g.exprs[i]));
    });
    return found;
}

struct Checker::State {
    Module& program;
    FloatPass& pass;
    Forward forward{program};
    World world{*program.names};
    Diagnostics diagnostics = {};
    Interpreter interpreter{program, diagnostics};
    std::vector<Column> columns = {};
    std::vector<GLuint> pictures = {};
    std::size_t shaders = 0;
    double driverSeconds = 0, interpreterSeconds = 0;

    // ---- Inputs ----

    // The column of each parameter that is a number; of a texture, the picture's number beyond them.
    std::vector<std::size_t> columnsOf(const Subject& s) {
        const Function& f = *program.find(s.function);
        std::vector<std::size_t> out;
        for (std::size_t k = 0; k < f.params.size(); k++) out.push_back(columnFor(f.params[k].type, s.domains[k], k));
        return out;
    }

    std::size_t columnFor(Type type, const Domain& domain, std::size_t ordinal) {
        const Scalar scalar = info(type).scalar;
        const int n = componentCount(type);
        for (std::size_t i = 0; i < columns.size(); i++)
            if (columns[i].scalar == scalar && columns[i].components == n && columns[i].ordinal == ordinal &&
                isSame(columns[i].domain, domain))
                return i;
        columns.push_back({scalar, n, ordinal, domain, {}});
        fill(columns.back());
        return columns.size() - 1;
    }

    static int pictureOf(const Function& f, std::size_t k) {
        int n = 0;
        for (std::size_t i = 0; i < k; i++) n += f.params[i].type == Type::Texture2D;
        return n % kParameterPictures;
    }

    Value argument(const Function& f, std::size_t k, std::size_t column, int pixel) {
        const Type type = f.params[k].type;
        if (type == Type::Texture2D) {
            TextureRef ref;
            ref.kind = TextureRef::Kind::Uniform;
            ref.uniform = program.names->intern(pictureName(pictureOf(f, k)));
            return textureValue(ref);
        }
        Value v = columns[column].values[static_cast<std::size_t>(pixel)];
        v.type = type;
        return v;
    }

    // ---- The driver ----

    struct Batch {
        std::span<const Subject> subjects;
        Module module;
        std::vector<std::size_t> firstSlot = {};
        std::size_t slots = 0;
        std::vector<int> rowOf = {};  // by column, -1 where it is not needed
        int rows = 0;
        std::vector<float> out = {};
    };

    ExprId texel(Builder& b, Batch& batch, int row, int rowsInTexture) {
        const float scale = 2.0f / static_cast<float>(rowsInTexture);
        ExprId place = b.attribute(batch.module.names->intern(kPlace), Type::Vector2);
        ExprId v = b.op(Op::Add, {b.op(Op::Mul, {b.component(place, 1), b.number(scale)}),
                                  b.number(scale * static_cast<float>(row))});
        ExprId uv = b.make(Type::Vector2, {b.component(place, 0), v});
        ExprId inputs = b.uniform(batch.module.names->intern(kInputs), Type::Texture2D);
        return b.emit(Op::TextureLevel, Type::Vector4, {inputs, uv, b.number(0)});
    }

    ExprId parameter(Builder& b, Batch& batch, Type type, int row, int height) {
        ExprId first = texel(b, batch, row, height);
        switch (info(type).scalar) {
            case Scalar::Boolean:
                return b.op(Op::Less, {b.number(0.5f), b.component(first, 0)});
            case Scalar::Integer: {
                ExprId high = b.convert(b.component(first, 0), Type::Integer),
                       low = b.convert(b.component(first, 1), Type::Integer);
                return b.op(Op::BitOr, {b.op(Op::ShiftLeft, {high, b.integer(16)}), low});
            }
            case Scalar::Float:
            case Scalar::None:
                break;
        }
        const int n = info(type).rows;
        const std::uint32_t mask = swizzleMask(n, 0, 1, 2, 3);
        if (isScalar(type)) return b.component(first, 0);
        if (!isMatrix(type)) {
            ExprId v = n == 4 ? first : b.swizzle(first, mask & (0x700u | ((1u << (2 * n)) - 1)));
            return b.convert(v, type);
        }
        std::vector<ExprId> parts;
        for (int c = 0; c < info(type).columns; c++) {
            ExprId t = texel(b, batch, row + c, height);
            parts.push_back(n == 4 ? t : b.swizzle(t, swizzleMask(3, 0, 1, 2)));
        }
        return b.make(type, parts);
    }

    void makeEntry(Batch& batch, Name entry) {
        Module& m = batch.module;
        m.sources.push_back(&forward);
        auto sampler = [&](std::string_view name) {
            Uniform u;
            u.name = m.names->intern(name);
            u.type = Type::Texture2D;
            m.uniforms.push_back(u);
        };
        sampler(kInputs);
        for (int i = 0; i < kParameterPictures; i++) sampler(pictureName(i));
        Uniform which;
        which.name = m.names->intern(kWhich);
        which.type = Type::Integer;
        which.values = {0};
        m.uniforms.push_back(which);

        for (const Subject& s : batch.subjects) columnsOf(s);  // makes those that are new
        batch.rowOf.assign(columns.size(), -1);
        for (const Subject& s : batch.subjects)
            for (std::size_t c : columnsOf(s))
                if (batch.rowOf[c] < 0 && columns[c].components) {
                    batch.rowOf[c] = batch.rows;
                    batch.rows += columns[c].texels();
                }
        batch.rows = static_cast<int>(std::bit_ceil(static_cast<unsigned>(batch.rows) * 2 + 2));
        Function f;
        f.name = entry;
        Builder b(m, f);
        Slots slots{b};
        for (const Subject& s : batch.subjects) {
            batch.firstSlot.push_back(slots.full.size());
            subject(b, batch, s, slots);
        }
        batch.slots = slots.full.size();
        b.addResult(m.names->intern("out1"), choose(b, b.uniform(which.name, Type::Integer), slots.full));
        m.put(std::move(f));
    }

    void subject(Builder& b, Batch& batch, const Subject& s, Slots& slots) {
        const Function& callee = *program.find(s.function);
        const std::vector<std::size_t> of = columnsOf(s);
        std::vector<ExprId> arguments;
        for (std::size_t k = 0; k < of.size(); k++) {
            const Type type = callee.params[k].type;
            if (type == Type::Texture2D)
                arguments.push_back(b.uniform(batch.module.names->intern(pictureName(pictureOf(callee, k))), type));
            else
                arguments.push_back(parameter(b, batch, type, batch.rowOf[of[k]], batch.rows));
        }
        const bool single = callee.results.size() == 1;
        ExprId call = b.call(callee.name, single ? callee.results[0].type : Type::Tuple, arguments);
        for (std::uint32_t k = 0; k < callee.results.size(); k++)
            slots.putValue(single ? call : b.result(call, k, callee.results[k].type));
        slots.flush();
    }

    // The value number `which`, by halves: drivers limit how deep branches may nest.
    static ExprId choose(Builder& b, ExprId which, std::vector<ExprId> values) {
        for (int step = 2; values.size() > 1; step *= 2) {
            std::vector<ExprId> half;
            for (std::size_t i = 0; i < values.size(); i += 2) {
                const int limit = static_cast<int>(i) * step / 2 + step / 2;
                half.push_back(i + 1 == values.size()
                                   ? values[i]
                                   : b.select(b.op(Op::Less, {which, b.integer(limit)}), values[i], values[i + 1]));
            }
            values = std::move(half);
        }
        return values[0];
    }

    // A triangle over everything, with the world's values at all of its corners.
    std::string vertexStage(const passes::ShaderInterface& interface, const Module& m) {
        std::string members, values;
        for (const passes::Varying& v : interface.varyings) {
            const std::string_view name = m.names->text(v.name);
            members += fmt::format("    {} {};\n", glsl::typeName(v.type), name);
            Value value = attributeValue(name, v.type);
            for (int c = 0; c < kContexts; c++)
                if (info(static_cast<Context>(c)).host == name) value = contextValue(static_cast<Context>(c));
            std::string text;
            if (name == kPlace)
                text = "place";
            else
                glsl::writeConstant(text, v.type, value.words);
            values += fmt::format("    vd.{} = {};\n", name, text);
        }
        return fmt::format(
            "#version 400\nout VertexData {{\n{}}} vd;\nvoid main() {{\n    vec2 place = 2.0 * vec2(gl_VertexID & 1, "
            "gl_VertexID >> 1);\n{}    gl_Position = vec4(2.0 * place - 1.0, 0.0, 1.0);\n}}\n",
            members, values);
    }

    std::vector<float> inputTexels(const Batch& batch) const {
        std::vector<float> texels(static_cast<std::size_t>(kWidth * batch.rows) * 4);
        for (std::size_t c = 0; c < batch.rowOf.size(); c++) {
            if (batch.rowOf[c] < 0) continue;
            const Column& column = columns[c];
            const int perTexel = column.components > 4 ? column.components / column.texels() : column.components;
            for (int p = 0; p < kPixels; p++)
                for (int i = 0; i < column.components; i++) {
                    const int row = (batch.rowOf[c] + i / perTexel) * kHeight + p / kWidth;
                    float* at = &texels[static_cast<std::size_t>((row * kWidth + p % kWidth) * 4)];
                    const Value& v = column.values[static_cast<std::size_t>(p)];
                    if (column.scalar == Scalar::Float) at[i % perTexel] = v.f(i);
                    if (column.scalar == Scalar::Boolean) at[0] = v.b() ? 1.0f : 0.0f;
                    if (column.scalar == Scalar::Integer) {
                        at[0] = static_cast<float>(v.words[0] >> 16);
                        at[1] = static_cast<float>(v.words[0] & 65535u);
                    }
                }
        }
        return texels;
    }

    // Fills `out`; false with a reason where a pass or the driver refuses.
    bool drive(Batch& batch, std::string& reason) {
        Module& m = batch.module;
        const Name pixel = m.names->intern("@pixel"), vertex = m.names->intern("@vertex");
        glsl::Sources sources;
        passes::ShaderInterface interface;
        try {
            makeEntry(batch, pixel);
            Diagnostics d;
            const std::unordered_set<Name> baked;
            if (!passes::specialise(m, pixel, baked, d)) return reason = d.text(), false;
            passes::prune(m, std::array{pixel});
            interface = passes::makeStages(m, pixel, vertex);
            for (auto& f : m.functions) glsl::legalise(*f);
            for (auto& f : m.functions) {
                passes::PlaceOptions how;
                how.isEntry = f->name == pixel;
                how.names = m.names;
                passes::place(*f, how);
            }
            sources = glsl::print(m, interface, "");
        } catch (const InternalError& e) {
            reason = e.what();
            return false;
        }
        PassJob job;
        job.vertex = vertexStage(interface, m);
        job.pixel = sources.pixel;
        job.which = kWhich;
        job.runs = static_cast<int>(batch.slots);
        for (int c = 0; c < kContexts; c++) {
            const ContextInfo& i = info(static_cast<Context>(c));
            if (i.source != ContextSource::Uniform) continue;
            const Value v = contextValue(static_cast<Context>(c));
            job.uniforms.push_back({std::string(i.host), v.type, {v.words, v.words + componentCount(v.type)}});
        }
        for (int i = 0; i < kParameterPictures; i++)
            job.textures.push_back({pictureName(i), pictures[static_cast<std::size_t>(i)]});
        job.textures.push_back({std::string(info(Context::EnvironmentRadiance).host), pictures[kParameterPictures]});
        job.textures.push_back(
            {std::string(info(Context::EnvironmentIrradiance).host), pictures[kParameterPictures + 1]});
        const GLuint inputs = pass.addTexture(kWidth, batch.rows, inputTexels(batch), false);
        job.textures.push_back({std::string(kInputs), inputs});
        if (const char* to = std::getenv("SHADERX_TABLE_DUMP")) {
            std::FILE* file = std::fopen(fmt::format("{}/{}.frag", to, shaders).c_str(), "w");
            if (file) std::fputs(job.pixel.c_str(), file), std::fclose(file);
        }
        shaders++;
        const bool fine = pass.run(job, batch.out, reason);
        if (!fine) reason += "\n" + (batch.subjects.size() == 1 ? job.pixel : std::string());
        pass.removeTexture(inputs);
        return fine;
    }

    // ---- The interpreter ----

    struct Bounds {
        double low = 0, high = 0;
        bool isFinite = true;
    };

    // Runs the pixels of one quad, or one pixel, for arguments moved by `random`, or not where it is null.
    bool interpret(const Subject& s, const std::vector<std::size_t>& of, std::span<const int> pixels,
                   std::mt19937* random, std::vector<Value>& arguments, std::vector<Value>& results) {
        const Function& f = *program.find(s.function);
        arguments.clear();
        for (int p : pixels)
            for (std::size_t k = 0; k < f.params.size(); k++) {
                Value v = argument(f, k, of[k], p);
                for (int i = 0; random && info(v.type).scalar == Scalar::Float && i < componentCount(v.type); i++)
                    v.set(i, moved(v.f(i), *random));
                arguments.push_back(v);
            }
        results.resize(f.results.size() * pixels.size());
        if (pixels.size() == 1) return interpreter.run(f, arguments, results, world);
        Environment* worlds[] = {&world, &world, &world, &world};
        return interpreter.runQuad(f, arguments, results, worlds);
    }

    static void widen(std::vector<Bounds>& bounds, std::span<const Value> results, bool first) {
        std::size_t at = 0;
        for (const Value& v : results)
            for (int i = 0; i < componentCount(v.type); i++, at++) {
                if (first) bounds.emplace_back();
                const double x = numberOf(v, i);
                Bounds& b = bounds[at];
                b.low = first ? x : std::min(b.low, x);
                b.high = first ? x : std::max(b.high, x);
                b.isFinite = b.isFinite && std::isfinite(x);
            }
    }

    // The number that the driver has for a result: those of a pixel in the order of the bounds.
    static std::vector<double> driven(const Batch& batch, std::size_t subject, const Function& f, int pixel) {
        std::vector<float> raw;
        for (std::size_t i = 0; i < floatsOf(f); i++)
            raw.push_back(
                batch
                    .out[((batch.firstSlot[subject] + i / 4) * kPixels + static_cast<std::size_t>(pixel)) * 4 + i % 4]);
        std::vector<double> out;
        std::size_t at = 0;
        for (const ResultValue& r : f.results)
            for (int i = 0; i < componentCount(r.type); i++) {
                const float x = raw[at++];
                if (info(r.type).scalar == Scalar::Integer)
                    out.push_back(static_cast<std::int32_t>(static_cast<std::uint32_t>(x) << 16 |
                                                            static_cast<std::uint32_t>(raw[at++])));
                else
                    out.push_back(x);
            }
        return out;
    }

    // A sample of moves does not reach the extremes, so what it spans counts once more on both sides.
    static bool agrees(double found, const Bounds& b, double tolerance) {
        const double slack = (b.high - b.low) + tolerance * std::max({1.0, std::fabs(b.low), std::fabs(b.high)});
        return found >= b.low - slack && found <= b.high + slack;
    }

    static bool isOperand(double found, std::span<const Value> arguments) {
        if (std::isnan(found)) return true;
        for (const Value& v : arguments)
            for (int i = 0; i < componentCount(v.type); i++)
                if (numberOf(v, i) == found) return true;
        return false;
    }
    static bool hasNan(std::span<const Value> arguments) {
        for (const Value& v : arguments)
            for (int i = 0; i < componentCount(v.type); i++)
                if (std::isnan(numberOf(v, i))) return true;
        return false;
    }

    void compare(const Batch& batch, std::size_t index, Outcome& outcome) {
        const Subject& s = batch.subjects[index];
        const Function& f = *program.find(s.function);
        const std::vector<std::size_t> of = columnsOf(s);
        const bool quads =
            anyOperation(program, f, [](const Function&, const Expr& e) { return e.op == Op::Ddx || e.op == Op::Ddy; });
        const bool coarse =
            anyOperation(program, f, [](const Function&, const Expr& e) { return isTranscendental(e.op); });
        const double tolerance = s.tolerance > 0 ? s.tolerance : coarse ? 1e-3 : 1e-6;
        for (int p = 0; p < kPixels && outcome.failure.empty(); p++) {
            if (!quads) {
                group(batch, index, of, std::array{p}, tolerance, outcome);
            } else if (p < kWidth && p % 2 == 0) {
                group(batch, index, of, std::array{p, p + 1, p + kWidth, p + kWidth + 1}, tolerance, outcome);
            }
        }
    }

    void group(const Batch& batch, std::size_t index, const std::vector<std::size_t>& of, std::span<const int> pixels,
               double tolerance, Outcome& outcome) {
        const Subject& s = batch.subjects[index];
        const Function& f = *program.find(s.function);
        std::mt19937 random(static_cast<std::uint32_t>(pixels[0]));
        std::vector<Value> arguments, results, first, firstResults;
        std::vector<Bounds> bounds;
        for (int move = 0; move <= kMoves; move++) {
            if (!interpret(s, of, pixels, move ? &random : nullptr, arguments, results)) {
                outcome.failure = fmt::format("{}: the interpreter refuses it\n{}", s.name, diagnostics.text());
                return;
            }
            if (move == 0) first = arguments, firstResults = results;
            widen(bounds, results, move == 0);
        }
        std::vector<double> found;
        for (int p : pixels) {
            const std::vector<double> one = driven(batch, index, f, p);
            found.insert(found.end(), one.begin(), one.end());
        }
        const std::size_t perPixel = bounds.size() / pixels.size();
        bool more = false;
        for (std::size_t i = 0; i < bounds.size(); i++) {
            const auto given = std::span<const Value>(first).subspan(i / perPixel * f.params.size(), f.params.size());
            if (s.mayGiveNan && hasNan(given)) {
                if (isOperand(found[i], given)) {
                    outcome.compared++;
                    continue;
                }
            } else if (!bounds[i].isFinite || (s.isDefined && !s.isDefined(given, static_cast<int>(i % perPixel)))) {
                outcome.undefined++;
                continue;
            } else if (agrees(found[i], bounds[i], tolerance)) {
                outcome.compared++;
                continue;
            }
            for (int move = 0; !more && move < kMoreMoves; move++)
                if (interpret(s, of, pixels, &random, arguments, results)) widen(bounds, results, false);
            more = true;
            if (!bounds[i].isFinite || agrees(found[i], bounds[i], tolerance)) continue;
            outcome.failure = fmt::format("{}: number {} of its results\n", s.name, i % perPixel);
            for (std::size_t k = 0; k < given.size(); k++)
                outcome.failure +=
                    fmt::format("    {} = {}\n", program.names->text(f.params[k].name), textOf(given[k]));
            if (pixels.size() > 1) outcome.failure += fmt::format("    in pixel {} of a quad\n", i / perPixel);
            outcome.failure += fmt::format("    the driver has {:.9g}, the interpreter {:.9g} to {:.9g}\n", found[i],
                                           bounds[i].low, bounds[i].high);
            return;
        }
    }
};

Checker::Checker(Module& program, FloatPass& pass) : state_(new State{program, pass}) {
    for (int i = 0; i < kPictures; i++)
        state_->pictures.push_back(pass.addTexture(kPictureSize, kPictureSize, picture(i), true));
}

Checker::~Checker() {
    for (GLuint t : state_->pictures) state_->pass.removeTexture(t);
}

std::size_t Checker::shaders() const { return state_->shaders; }
double Checker::driverSeconds() const { return state_->driverSeconds; }
double Checker::interpreterSeconds() const { return state_->interpreterSeconds; }

std::vector<Outcome> Checker::check(const std::vector<Subject>& subjects) {
    using Clock = std::chrono::steady_clock;
    auto seconds = [](Clock::time_point since) { return std::chrono::duration<double>(Clock::now() - since).count(); };
    std::vector<Outcome> outcomes(subjects.size());
    // Ranges still to be run, the first one last. A range that is refused is tried again by halves, to find who it is.
    std::vector<std::pair<std::size_t, std::size_t>> todo;
    for (std::size_t begin = 0; begin < subjects.size();) {
        std::size_t end = begin, size = 0;
        for (; end < subjects.size() && (end == begin || size < kMostExprs); end++)
            forCallees(state_->program, *state_->program.find(subjects[end].function),
                       [&](const Function& f) { size += f.exprs.size(); });
        todo.push_back({begin, end});
        begin = end;
    }
    std::reverse(todo.begin(), todo.end());
    while (!todo.empty()) {
        const auto [begin, end] = todo.back();
        todo.pop_back();
        State::Batch batch{std::span(subjects).subspan(begin, end - begin), Module(*state_->program.names)};
        std::string reason;
        Clock::time_point start = Clock::now();
        const bool fine = state_->drive(batch, reason);
        state_->driverSeconds += seconds(start);
        if (!fine && end - begin > 1) {
            const std::size_t middle = (begin + end) / 2;
            todo.push_back({middle, end});
            todo.push_back({begin, middle});
            continue;
        }
        if (!fine) {
            outcomes[begin].failure = subjects[begin].name + ": cannot be drawn\n" + reason;
            continue;
        }
        start = Clock::now();
        for (std::size_t i = begin; i < end; i++) state_->compare(batch, i - begin, outcomes[i]);
        state_->interpreterSeconds += seconds(start);
    }
    return outcomes;
}

}  // namespace shaderx::table
