#include "targets/text/writer.h"

namespace shaderx::text {

std::string_view Writer::firstSentence(std::string_view sentences) {
    auto isLower = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == ')'; };
    auto isBlank = [](char c) { return c == ' ' || c == '\n'; };
    for (std::size_t i = 2; i < sentences.size(); i++) {
        if (sentences[i] == '\n' && sentences[i - 1] == '\n') return sentences.substr(0, i - 1);
        // Not after "eq." or an initial: a word of two letters at least, and a capital follows.
        if (sentences[i] != '.' || !isLower(sentences[i - 1]) || isBlank(sentences[i - 2])) continue;
        std::size_t next = i + 1;
        while (next < sentences.size() && isBlank(sentences[next])) next++;
        if (next == sentences.size() || (next > i + 1 && sentences[next] >= 'A' && sentences[next] <= 'Z'))
            return sentences.substr(0, i + 1);
    }
    return sentences;
}

void Writer::comment(std::string_view sentences, std::size_t width) {
    std::string current;
    auto flush = [&] {
        if (!current.empty()) line("//" + current);
        current.clear();
    };
    std::size_t i = 0;
    while (i < sentences.size()) {
        std::size_t end = sentences.find_first_of(" \n\r\t", i);
        if (end == std::string_view::npos) end = sentences.size();
        std::string_view word = sentences.substr(i, end - i);
        if (!word.empty()) {
            if (!current.empty() && current.size() + word.size() + 3 > width) flush();
            current.append(" ").append(word);
        }
        i = end + 1;
    }
    // A comment must not go on in the next line.
    while (!current.empty() && current.back() == '\\') current.pop_back();
    flush();
}

}  // namespace shaderx::text
