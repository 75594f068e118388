// Lines of text, indented by tabs: one character for each level, as wide as the reader likes.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace shaderx::text {

class Writer {
  public:
    Writer() { out_.reserve(kUsual); }
    // A whole line at the present depth; an empty one stays empty.
    void line(std::string_view text = {}) {
        if (!text.empty()) begin().append(text);
        out_ += '\n';
    }
    // The same, from parts.
    void line(std::initializer_list<std::string_view> parts) {
        begin();
        for (std::string_view part : parts) out_.append(part);
        out_ += '\n';
    }
    // A line bit by bit: what is appended to the text that begin() returns, up to end(), is its content.
    std::string& begin() { return out_.append(static_cast<std::size_t>(depth_), '\t'); }
    void end(std::string_view text = {}) { out_.append(text) += '\n'; }
    // Lines as they are.
    void raw(std::string_view lines) { out_.append(lines); }
    std::string_view since(std::size_t start) const { return std::string_view(out_).substr(start); }
    void open(std::string_view text) {
        line(text);
        line("{");
        depth_++;
    }
    void close(std::string_view text = "}") {
        depth_--;
        line(text);
    }
    // Sentences as line comments, wrapped at `width` characters.
    void comment(std::string_view sentences, std::size_t width = 118);
    // The first of some sentences: what a reader of generated text wants to know of a function.
    static std::string_view firstSentence(std::string_view sentences);
    std::string take() { return std::move(out_); }
    std::size_t size() const { return out_.size(); }
    int depth() const { return depth_; }

  private:
    static constexpr std::size_t kUsual = 8192;  // characters of a shader

    std::string out_;
    int depth_ = 0;
};

}  // namespace shaderx::text
