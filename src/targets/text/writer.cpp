#include "targets/text/writer.h"

namespace shaderx::text {

std::string_view Writer::firstSentence(std::string_view sentences) {
    auto isLower = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == ')'; };
    auto isBlank = [](char c) { return c == ' ' || c == '\n'; };
    if (std::size_t paragraph = sentences.find("\n\n", 1); paragraph != std::string_view::npos)
        sentences = sentences.substr(0, paragraph);
    for (std::size_t i = sentences.find('.', 2); i != std::string_view::npos; i = sentences.find('.', i + 1)) {
        // Not after "eq." or an initial: a word of two letters at least, and a capital follows.
        if (!isLower(sentences[i - 1]) || isBlank(sentences[i - 2])) continue;
        std::size_t next = i + 1;
        while (next < sentences.size() && isBlank(sentences[next])) next++;
        if (next == sentences.size() || (next > i + 1 && sentences[next] >= 'A' && sentences[next] <= 'Z'))
            return sentences.substr(0, i + 1);
    }
    return sentences;
}

void Writer::comment(std::string_view sentences, std::size_t width) {
    auto isBlank = [](char c) { return (c >= 0 && c <= ' ') || c == 0x7f; };  // no sign that moves or deletes
    std::size_t column = 0;  // characters of the line so far, none before its first word
    // A comment must not go on in the next line.
    auto flush = [&](bool isLast) {
        while (isLast && out_.back() == '\\') out_.pop_back();
        out_ += '\n';
        column = 0;
    };
    for (std::size_t i = 0; i < sentences.size();) {
        std::size_t end = i;
        while (end < sentences.size() && !isBlank(sentences[end])) end++;
        std::string_view word = sentences.substr(i, end - i);
        i = end + 1;
        if (word.empty()) continue;
        if (column && column + word.size() + 3 > width) flush(false);
        if (!column) begin().append("//");
        out_.append(" ").append(word);
        column += 1 + word.size();
    }
    if (column) flush(true);
}

}  // namespace shaderx::text
