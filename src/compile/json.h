// Writes JSON text: objects of a list one a line, numbers as short as they can be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace shaderx {

// The caller keeps the grammar; the writer puts commas, quotes and line ends.
class JsonWriter {
  public:
    JsonWriter() : out_(4096, '\0') {}
    // The document itself, and what is spread over lines: a member or element a line.
    void openObject() { open('{', true); }
    void openArray() { open('[', true); }
    // What stays on one line.
    void openShortObject() { open('{', false); }
    void openShortArray() { open('[', false); }
    void closeObject() { close('}'); }
    void closeArray() { close(']'); }

    void key(std::string_view name);    // plain letters
    void text(std::string_view value);  // bytes that are no UTF-8 become U+FFFD
    void boolean(bool value) { word(value ? "true" : "false"); }
    void integer(std::int64_t value);
    void number(float value);  // null where it is none
    void null() { word("null"); }
    // A member whose value is a text; none where it is empty.
    void member(std::string_view name, std::string_view value) {
        if (value.empty()) return;
        key(name);
        text(value);
    }

    std::string take() {
        out_.resize(size_);
        return std::move(out_);
    }

  private:
    void open(char bracket, bool lines);
    void close(char bracket);
    void word(std::string_view text);

    // Writes what stands before a value; then, where its characters go, of which there are at most so many. Whoever
    // writes them tells `end` where they end.
    char* begin(std::size_t characters);
    void end(const char* at) { size_ = static_cast<std::size_t>(at - out_.data()); }
    char* room(std::size_t characters) {
        if (out_.size() - size_ < characters) out_.resize(2 * out_.size() + characters);
        return out_.data() + size_;
    }

    std::string out_;          // the text so far, and room for more
    std::size_t size_ = 0;     // of the text
    std::uint64_t lines_ = 0;  // bit of a depth: its members stand on lines of their own
    int depth_ = 0;            // at most 63
    bool first_ = true, keyed_ = false;
};

}  // namespace shaderx
