// What went wrong, where, and what to do about it. A user's mistake is a diagnostic, never an exception or an exit.
// A note is no mistake: it is worth knowing.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace shaderx {

enum class Severity : std::uint8_t { Note, Warning, Error, Internal };

// A place in a source text; line and column count from 1, columns in bytes; line 0 means the place is not known.
struct Location {
    std::string file;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

// The line and column of a byte offset in a text.
Location locate(std::string_view file, std::string_view text, std::size_t offset);

struct Note {
    Location where;  // may be empty
    std::string message;
};

struct Diagnostic {
    Severity severity = Severity::Error;
    std::string code;     // stable, in lower case with hyphens: "unknown-node"
    std::string message;  // one lower-case sentence without a full stop
    Location where;       // may be empty
    std::string path;     // of the node: "NG_wood/mix1", may be empty
    std::vector<Note> notes;
    std::string hint;  // "did you mean 'base_color'?", may be empty
};

// The text with what a terminal would obey in place of showing it, written out: control characters (C0, C1, DEL), line
// ends, marks that turn the direction of text, and bytes that are no UTF-8, as \n, \x1b or \u202e.
std::string visible(std::string_view text);
// The same of a text of several lines: line ends and tabs stay.
std::string visibleLines(std::string_view text);
// Whether a terminal would obey a character in place of showing it.
bool isControl(char32_t c);
// The character at the start of a text that is not empty, and how many bytes it takes; a byte that is no UTF-8 stands
// for itself, as one of 0x80 to 0xff that takes one.
char32_t characterAt(std::string_view text, std::size_t& size);

// `file:line:col: error: message [code]`, then the node path, notes and hint, one a line, each with a line end. What
// comes from the user is made visible.
std::string format(const Diagnostic& d);

// Collects the diagnostics of a compilation in the order in which they were found.
class Diagnostics {
  public:
    Diagnostic& add(Severity severity, std::string_view code, std::string message);
    Diagnostic& add(Diagnostic diagnostic);
    Diagnostic& error(std::string_view code, std::string message) {
        return add(Severity::Error, code, std::move(message));
    }
    Diagnostic& warning(std::string_view code, std::string message) {
        return add(Severity::Warning, code, std::move(message));
    }
    Diagnostic& note(std::string_view code, std::string message) {
        return add(Severity::Note, code, std::move(message));
    }
    const std::vector<Diagnostic>& all() const { return all_; }
    // Errors so far, internal ones included: compare before and after a step to learn whether it failed.
    std::size_t errorCount() const { return errors_; }
    bool hasErrors() const { return errors_ != 0; }
    bool hasInternal() const { return internals_ != 0; }
    std::string text() const;

  private:
    std::vector<Diagnostic> all_;
    std::size_t errors_ = 0, internals_ = 0;
};

// Tells what says something new from what says the same of the same place.
class Unrepeated {
  public:
    bool isNew(const Diagnostic& d);

  private:
    std::unordered_set<std::string> said_;
};

// The candidate nearest to `word` by edit distance, if near enough to be a likely misspelling, else empty.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

// A bug of ours. Thrown deep inside, caught at the public interface, which turns it into an internal diagnostic.
struct InternalError : std::logic_error {
    using std::logic_error::logic_error;
};

[[noreturn]] void internalError(const std::string& what);

// A broken invariant is an internal error; `what` says which one.
inline void ensure(bool holds, const char* what) {
    if (!holds) internalError(what);
}

}  // namespace shaderx
