// Programs in the text form of the IR, read, shown and run.
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "apps/cli/commands.h"
#include "apps/cli/files.h"
#include "base/numbers.h"
#include "compile/compile.h"
#include "ir/interpret.h"
#include "ir/text.h"
#include "ir/validate.h"
#include "passes/stages.h"

namespace shaderx::cli {

namespace {

using ir::Scalar;
using ir::Type;
using ir::Value;

// A text and the program that it makes. It may call the functions of the node library, as the dumps of `lower` do.
struct Source {
    NameTable names{namesOf(builtinLibrary())};
    std::unique_ptr<Library> library = openLibrary(names, builtinLibrary());
    ir::Module module{names};
    Diagnostics diagnostics{};
    std::vector<ir::Function*> functions{};

    bool read(const std::string& file) {
        std::string text;
        if (!readInput(file, text, diagnostics)) return false;
        if (library) module.sources.push_back(library.get());
        Result<std::vector<ir::Function*>> parsed = ir::parse(module, file, text, diagnostics);
        if (!parsed) return false;
        functions = *parsed;
        // A broken rule is the text's mistake here, not ours.
        Diagnostics broken;
        ir::validate(module, broken);
        for (const Diagnostic& d : broken.all()) {
            Diagnostic& e = diagnostics.error(d.code, d.message);
            e.where = placeOf(file, text, d);
            e.notes = d.notes;
        }
        return !diagnostics.hasErrors();
    }

    // Where a message of `validate` belongs, whose note starts with "in NAME:" and the expression's line, numbered.
    static Location placeOf(const std::string& file, std::string_view text, const Diagnostic& d) {
        Location place{file, 0, 0};
        std::string_view note = d.notes.empty() ? std::string_view() : d.notes[0].message;
        std::size_t colon = note.find(":\n"), percent = note.find('%');
        if (!note.starts_with("in ") || colon == std::string_view::npos) return place;
        std::string_view name = note.substr(3, colon - 3);
        int left = percent == std::string_view::npos ? -1 : std::atoi(note.data() + percent + 1);
        bool inside = false;
        std::uint32_t line = 0;
        for (std::size_t at = 0; at < text.size();) {
            std::size_t end = std::min(text.find('\n', at), text.size());
            std::string_view row = trim(text.substr(at, end - at));
            const char* start = text.data() + at;
            line++;
            at = end + 1;
            std::size_t head = row.find("function ");
            if (head == 0 || row.starts_with("inline function ")) {
                std::string_view rest = row.substr(head + 9);
                if (rest.starts_with('"')) rest.remove_prefix(1);
                inside = rest.starts_with(name) && rest.find_first_of("(\"") == name.size();
                if (inside) place = {file, line, 1};
            } else if (inside && row.starts_with('%') && left-- == 0) {
                return {file, line, static_cast<std::uint32_t>(row.data() - start) + 1};
            }
        }
        return place;
    }

    int report() const {
        std::fputs(diagnostics.text().c_str(), stderr);
        return diagnostics.hasInternal() ? kOurBug : diagnostics.hasErrors() ? kInputErrors : kDone;
    }

    const ir::Function* function(const Options& options) {
        if (functions.empty())
            diagnostics.error("no-function", "the text has no function").where.file = options.files[0];
        if (functions.empty() || options.function.empty()) return functions.empty() ? nullptr : functions.back();
        std::vector<std::string_view> known;
        for (const ir::Function* f : functions) {
            known.push_back(names.text(f->name));
            if (known.back() == options.function) return f;
        }
        Diagnostic& e = diagnostics.error("unknown-function", "there is no function '" + options.function + "'");
        e.where.file = options.files[0];
        if (std::string_view near = nearest(options.function, known); !near.empty())
            e.hint = fmt::format("did you mean '{}'?", near);
        return nullptr;
    }
};

// What the host's variables are until they are set; nothing else is known here.
struct Defaults : ir::Environment {
    bool context(ir::Context c, Value& v) override {
        if (ir::info(c).source != ir::ContextSource::Uniform) return false;
        std::vector<std::uint32_t> words = passes::defaultOf(c);
        std::copy(words.begin(), words.end(), v.words);
        return true;
    }
};

bool parseNumber(std::string_view text, Scalar kind, std::uint32_t& word) {
    text = trim(text);
    if (kind == Scalar::Boolean) {
        word = text == "true";
        return text == "true" || text == "false";
    }
    if (kind == Scalar::Integer) {
        std::optional<int> i = parseInt(text);
        if (i) word = static_cast<std::uint32_t>(*i);
        return i.has_value();
    }
    std::optional<float> f = parseFloat(text);
    Value v;
    if (f) v.set(0, *f);
    word = v.words[0];
    return f.has_value();
}

bool parseValue(std::string_view text, Type type, Value& v) {
    v.type = type;
    int n = ir::componentCount(type);
    if (n == 0) return false;
    for (int i = 0; i < n; i++) {
        std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i == n - 1)) return false;
        if (!parseNumber(text.substr(0, comma), ir::info(type).scalar, v.words[i])) return false;
        if (comma != std::string_view::npos) text.remove_prefix(comma + 1);
    }
    return true;
}

std::string textOf(const Value& v) {
    std::string text;
    for (int i = 0; i < ir::componentCount(v.type); i++) {
        if (i > 0) text += ", ";
        Scalar kind = ir::info(v.type).scalar;
        text += kind == Scalar::Boolean   ? (v.words[i] ? "true" : "false")
                : kind == Scalar::Integer ? std::to_string(v.i(i))
                                          : formatFloat(v.f(i));
    }
    return text;
}

}  // namespace

int showIr(const Options& options) {
    Source source;
    if (source.read(options.files[0])) std::fputs(ir::print(source.module).c_str(), stdout);
    return source.report();
}

int evaluate(const Options& options) {
    Source source;
    const ir::Function* f = source.read(options.files[0]) ? source.function(options) : nullptr;
    if (!f) return source.report();
    std::string_view name = source.names.text(f->name);
    if (options.arguments.size() != f->params.size()) {
        source.diagnostics.error("argument-count", fmt::format("'{}' takes {} arguments, not {}", name,
                                                               f->params.size(), options.arguments.size()));
        return source.report();
    }
    std::vector<Value> arguments(f->params.size()), results(f->results.size());
    for (std::size_t k = 0; k < arguments.size(); k++) {
        const ir::Param& p = f->params[k];
        if (parseValue(options.arguments[k], p.type, arguments[k])) continue;
        source.diagnostics.error("bad-argument",
                                 fmt::format("'{}' is no {} for the parameter '{}' of '{}'", options.arguments[k],
                                             ir::info(p.type).name, source.names.text(p.name), name));
    }
    Defaults defaults;
    ir::Interpreter interpreter(source.module, source.diagnostics);
    if (source.diagnostics.hasErrors() || !interpreter.run(*f, arguments, results, defaults)) return source.report();
    for (std::size_t k = 0; k < results.size(); k++)
        std::puts(visible(fmt::format("{} = {}", source.names.text(f->results[k].name), textOf(results[k]))).c_str());
    return source.report();
}

}  // namespace shaderx::cli
