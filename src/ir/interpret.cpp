#include "ir/interpret.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include <fmt/format.h>

#include "ir/interpret_program.h"
#include "ir/text.h"
#include "ir/validate.h"

namespace shaderx::ir {

Value textureValue(const TextureRef& texture) {
    Value v;
    v.type = Type::Texture2D;
    v.words[0] = static_cast<std::uint32_t>(texture.kind);
    v.words[1] = texture.kind == TextureRef::Kind::Uniform   ? texture.uniform.index
                 : texture.kind == TextureRef::Kind::Context ? static_cast<std::uint32_t>(texture.context)
                                                             : 0;
    return v;
}

static TextureRef textureOf(const std::uint32_t* words) {
    TextureRef t;
    t.kind = static_cast<TextureRef::Kind>(words[0]);
    if (t.kind == TextureRef::Kind::Uniform) t.uniform = Name(words[1]);
    if (t.kind == TextureRef::Kind::Context) t.context = static_cast<Context>(words[1]);
    return t;
}

namespace {

struct Frame {
    Program* program = nullptr;
    std::uint32_t at = 0;  // the next instruction; of a frame that waits, its call
    std::size_t base = 0;  // of its registers
};

enum class Outcome : std::uint8_t { Done, Failed, Waiting };  // waiting at a derivative

// One pixel.
struct Lane {
    Environment* environment = nullptr;
    std::vector<Frame> frames = {};
    std::vector<std::uint32_t> words = {};
    std::uint64_t steps = 0;
};

}  // namespace

struct Interpreter::State {
    const Module& module;
    Diagnostics& diagnostics;
    InterpreterOptions options;
    std::unordered_map<const Function*, std::unique_ptr<Program>> programs = {};
    std::vector<Lane> lanes = std::vector<Lane>(4);  // kept for their memory
    std::vector<Operand> operands = {};
    std::uint64_t steps = 0;

    bool fail(const Frame& frame, const Instruction& in, std::string_view code, std::string message) {
        const Function& f = *frame.program->function;
        Diagnostic& d = diagnostics.error(code, std::move(message));
        const std::string line = in.expr ? printExpr(module, f, in.expr) : "return";
        d.notes.push_back({{}, fmt::format("in {}:\n    {}", module.names->text(f.name), line)});
        return false;
    }

    // The translation of a function, or null where it has errors.
    Program* programOf(const Function& f) {
        const auto [it, isNew] = programs.emplace(&f, nullptr);
        if (!isNew && it->second) return it->second.get();
        auto program = std::make_unique<Program>();
        if (!validate(module, f, diagnostics) || !translate(module, f, diagnostics, *program)) return nullptr;
        it->second = std::move(program);
        return it->second.get();
    }

    static const std::uint32_t* read(const Lane& lane, const Frame& frame, Slot slot) {
        return slot & kConstantSlot ? frame.program->constants.data() + (slot & ~kConstantSlot)
                                    : lane.words.data() + frame.base + slot;
    }
    static std::uint32_t* write(Lane& lane, const Frame& frame, Slot slot) {
        return lane.words.data() + frame.base + slot;
    }
    static const Source& sourceOf(const Frame& frame, const Instruction& in, std::uint32_t k) {
        return frame.program->sources[in.firstSource + k];
    }
    static const std::uint32_t* sourceWords(const Lane& lane, const Frame& frame, const Instruction& in,
                                            std::uint32_t k) {
        return read(lane, frame, sourceOf(frame, in, k).slot);
    }

    // ---- Instructions ----

    bool executeOp(Lane& lane, const Frame& frame, const Instruction& in) {
        operands.resize(in.sourceCount);
        for (std::uint32_t k = 0; k < in.sourceCount; k++)
            operands[k] = {sourceOf(frame, in, k).type, sourceWords(lane, frame, in, k)};
        if (execute(in.op, in.type, operands, in.payload, write(lane, frame, in.destination))) return true;
        return fail(frame, in, "cannot-interpret", fmt::format("the interpreter does not run '{}'", info(in.op).name));
    }

    void store(Lane& lane, const Frame& frame, const Instruction& in, const Value& v) {
        std::copy_n(v.words, frameWords(in.type), write(lane, frame, in.destination));
    }

    bool fetch(Lane& lane, const Frame& frame, const Instruction& in) {
        Value v;
        v.type = in.type;
        bool known = true;
        if (in.op == Op::Context) {
            const Context c = static_cast<Context>(in.payload);
            if (in.type == Type::Texture2D)
                v = textureValue({TextureRef::Kind::Context, {}, c});
            else
                known = lane.environment->context(c, v);
        } else if (in.op == Op::Attribute) {
            known = lane.environment->attribute(Name(in.payload), v);
        } else if (in.type == Type::Texture2D) {
            v = textureValue({TextureRef::Kind::Uniform, Name(in.payload), {}});
        } else if (!lane.environment->uniform(Name(in.payload), v)) {
            const auto& usual = module.uniforms[in.target].values;
            known = usual.size() == frameWords(in.type);
            if (known) std::copy(usual.begin(), usual.end(), v.words);
        }
        if (!known || v.type != in.type)
            return fail(frame, in, "no-value", "nothing supplies the value that the program asks for");
        store(lane, frame, in, v);
        return true;
    }

    bool texture(Lane& lane, const Frame& frame, const Instruction& in) {
        Value v;
        v.type = in.type;
        const auto pair = [&](std::uint32_t k, float out[2]) {
            for (int i = 0; i < 2; i++) {
                Value word;
                word.words[0] = sourceWords(lane, frame, in, k)[i];
                out[i] = word.f(0);
            }
        };
        TextureRead r;
        r.texture = textureOf(sourceWords(lane, frame, in, 0));
        bool known = false;
        if (in.op == Op::TextureSize) {
            known = lane.environment->textureSize(r.texture, v);
        } else {
            pair(1, r.uv);
            r.hasGradients = in.op == Op::TextureGrad;
            if (r.hasGradients) {
                pair(2, r.ddx);
                pair(3, r.ddy);
            } else {
                Value level;
                level.words[0] = sourceWords(lane, frame, in, 2)[0];
                r.level = level.f(0);
            }
            known = lane.environment->texture(r, v);
        }
        if (!known || v.type != in.type) return fail(frame, in, "no-value", "nothing supplies the image");
        store(lane, frame, in, v);
        return true;
    }

    // Enters the callee. `frame` is the caller's, which the frames may move away from under.
    bool call(Lane& lane, const Instruction& in) {
        const Frame frame = lane.frames.back();
        if (lane.frames.size() > options.maxDepth)
            return fail(frame, in, "depth-limit", fmt::format("more than {} calls within calls", options.maxDepth));
        Program*& callee = frame.program->callees[frame.at];
        if (!callee) {
            const Function* f = module.find(Name(in.payload));
            callee = f ? programOf(*f) : nullptr;
            if (!callee) return fail(frame, in, "cannot-interpret", "the function cannot be run");
        }
        const std::size_t base = lane.words.size();
        lane.words.resize(base + callee->frameWords);
        std::size_t at = base;
        for (std::uint32_t k = 0; k < in.sourceCount; k++) {
            const std::uint32_t n = frameWords(sourceOf(frame, in, k).type);
            std::copy_n(sourceWords(lane, frame, in, k), n, lane.words.data() + at);
            at += n;
        }
        lane.frames.push_back({callee, 0, base});
        return true;
    }

    // Hands the results to the caller. False at the end of the outermost function, whose frame stays.
    bool leave(Lane& lane) {
        if (lane.frames.size() == 1) return false;
        const Frame done = lane.frames.back();
        lane.frames.pop_back();
        Frame& caller = lane.frames.back();
        Slot to = caller.program->code[caller.at].destination;
        for (const Source& s : done.program->results) {
            std::copy_n(read(lane, done, s.slot), frameWords(s.type), write(lane, caller, to));
            to += frameWords(s.type);
        }
        lane.words.resize(done.base);
        caller.at++;
        return true;
    }

    // Runs a pixel until it is done or waits.
    Outcome advance(Lane& lane) {
        while (true) {
            Frame& frame = lane.frames.back();
            const Instruction& in = frame.program->code[frame.at];
            if (++lane.steps > options.maxSteps) {
                fail(frame, in, "step-limit", fmt::format("the program runs for more than {} steps", options.maxSteps));
                return Outcome::Failed;
            }
            bool fine = true;
            std::uint32_t next = frame.at + 1;
            switch (in.code) {
                case Code::Execute:
                    fine = executeOp(lane, frame, in);
                    break;
                case Code::Fetch:
                    fine = fetch(lane, frame, in);
                    break;
                case Code::Texture:
                    fine = texture(lane, frame, in);
                    break;
                case Code::Derivative:
                    return Outcome::Waiting;
                case Code::Call:
                    if (!call(lane, in)) return Outcome::Failed;
                    continue;
                case Code::Copy:
                    std::copy_n(sourceWords(lane, frame, in, 0), in.target, write(lane, frame, in.destination));
                    break;
                case Code::Jump:
                    next = in.target;
                    break;
                case Code::JumpIfFalse:
                    if (!*sourceWords(lane, frame, in, 0)) next = in.target;
                    break;
                case Code::LoopTest: {
                    const auto index = static_cast<std::int32_t>(*sourceWords(lane, frame, in, 0));
                    const auto count = static_cast<std::int32_t>(*sourceWords(lane, frame, in, 1));
                    if (index >= count) next = in.target;
                    break;
                }
                case Code::LoopNext:
                    ++*write(lane, frame, in.destination);
                    next = in.target;
                    break;
                case Code::Return:
                    if (!leave(lane)) return Outcome::Done;
                    continue;
            }
            if (!fine) return Outcome::Failed;
            frame.at = next;
        }
    }

    // ---- Runs ----

    bool start(Lane& lane, const Function& f, Program* program, std::span<const Value> arguments, Environment& e) {
        lane.environment = &e;
        lane.steps = 0;
        lane.frames.assign(1, {program, 0, 0});
        lane.words.assign(program->frameWords, 0);
        std::size_t at = 0;
        for (std::size_t k = 0; k < f.params.size(); k++) {
            if (arguments[k].type != f.params[k].type) {
                diagnostics.error("argument-type",
                                  fmt::format("argument {} of '{}' is {}, not {}", k + 1, module.names->text(f.name),
                                              info(arguments[k].type).name, info(f.params[k].type).name));
                return false;
            }
            const std::uint32_t n = frameWords(f.params[k].type);
            std::copy_n(arguments[k].words, n, lane.words.data() + at);
            at += n;
        }
        return true;
    }

    void finish(const Lane& lane, std::span<Value> results) {
        const Frame& frame = lane.frames.front();
        for (std::size_t k = 0; k < results.size(); k++) {
            const Source& s = frame.program->results[k];
            results[k] = Value();
            results[k].type = s.type;
            std::copy_n(read(lane, frame, s.slot), frameWords(s.type), results[k].words);
        }
    }

    // Gives each pixel the difference that it waits for.
    bool derive() {
        const std::vector<Frame>& first = lanes[0].frames;
        const Frame frame = first.back();
        const Instruction& in = frame.program->code[frame.at];
        for (const Lane& lane : lanes) {
            bool same = lane.frames.size() == first.size();
            for (std::size_t i = 0; same && i < first.size(); i++)
                same = lane.frames[i].program == first[i].program && lane.frames[i].at == first[i].at;
            if (!same)
                return fail(frame, in, "non-uniform", "the pixels of a quad reach a derivative by different ways");
        }
        const std::size_t step = in.op == Op::Ddx ? 1 : 2;
        std::array<Value, 4> differences;
        for (std::size_t i = 0; i < 4; i++) {
            const std::size_t low = i & ~step, high = i | step;
            Value a, b;
            std::copy_n(sourceWords(lanes[low], lanes[low].frames.back(), in, 0), frameWords(in.type), a.words);
            std::copy_n(sourceWords(lanes[high], lanes[high].frames.back(), in, 0), frameWords(in.type), b.words);
            for (int c = 0; c < componentCount(in.type); c++) differences[i].set(c, b.f(c) - a.f(c));
        }
        for (std::size_t i = 0; i < 4; i++) {
            store(lanes[i], lanes[i].frames.back(), in, differences[i]);
            lanes[i].frames.back().at++;
        }
        return true;
    }

    bool run(const Function& f, std::size_t pixels, std::span<const Value> arguments, std::span<Value> results,
             std::span<Environment* const> environments) {
        steps = 0;
        if (arguments.size() != f.params.size() * pixels || results.size() != f.results.size() * pixels ||
            environments.size() != pixels) {
            diagnostics.error("argument-count",
                              fmt::format("'{}' takes {} arguments and gives {} results", module.names->text(f.name),
                                          f.params.size(), f.results.size()));
            return false;
        }
        Program* program = programOf(f);
        if (!program) return false;
        for (std::size_t i = 0; i < pixels; i++)
            if (!start(lanes[i], f, program, arguments.subspan(i * f.params.size(), f.params.size()), *environments[i]))
                return false;
        while (true) {
            std::size_t waiting = 0, last = 0;  // how many wait, and one of them
            for (std::size_t i = 0; i < pixels; i++) {
                const Outcome outcome = advance(lanes[i]);
                if (outcome == Outcome::Failed) return false;
                if (outcome != Outcome::Waiting) continue;
                waiting++;
                last = i;
            }
            if (waiting == 0) break;
            const Frame& frame = lanes[last].frames.back();
            const Instruction& in = frame.program->code[frame.at];
            if (pixels != 4) return fail(frame, in, "needs-quad", "a derivative needs a quad of pixels");
            if (waiting != 4) return fail(frame, in, "non-uniform", "only some pixels of a quad reach a derivative");
            if (!derive()) return false;
        }
        for (std::size_t i = 0; i < pixels; i++) {
            steps += lanes[i].steps;
            finish(lanes[i], results.subspan(i * f.results.size(), f.results.size()));
        }
        return true;
    }
};

Interpreter::Interpreter(const Module& module, Diagnostics& diagnostics, InterpreterOptions options)
    : state_(new State{module, diagnostics, options}) {}
Interpreter::~Interpreter() = default;

bool Interpreter::run(const Function& function, std::span<const Value> arguments, std::span<Value> results,
                      Environment& environment) {
    Environment* const one[] = {&environment};
    return state_->run(function, 1, arguments, results, one);
}

bool Interpreter::runQuad(const Function& function, std::span<const Value> arguments, std::span<Value> results,
                          std::span<Environment* const> environments) {
    return state_->run(function, 4, arguments, results, environments);
}

std::uint64_t Interpreter::steps() const { return state_->steps; }

}  // namespace shaderx::ir
