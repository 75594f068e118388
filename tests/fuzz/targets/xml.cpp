// Bytes as a document: reading, upgrading, checking and writing it, and reading again gives the same.
#include "compile/compile.h"
#include "doc/write.h"
#include "fuzz/fuzzer.h"

using namespace shaderx;

static bool same(const doc::Document& a, const doc::Document& b) {
    if (a.size() != b.size()) return false;
    for (std::uint32_t i = 0; i < a.size(); i++) {
        const doc::ElementId e(i);
        if (a[e].category != b[e].category || a[e].parent != b[e].parent || a[e].next != b[e].next) return false;
        const auto x = a.attributes(e), y = b.attributes(e);
        if (x.size() != y.size()) return false;
        for (std::size_t k = 0; k < x.size(); k++)
            if (x[k].name != y[k].name || x[k].value != y[k].value) return false;
    }
    return true;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    const auto document = compiler.read("fuzz.mtlx", std::string(fuzz::textOf(data, size)), none, diagnostics);
    fuzz::expect(!diagnostics.hasInternal(), diagnostics.text());
    fuzz::expect(document || diagnostics.hasErrors(), "no document, and no error");
    if (!document) return 0;
    compiler.validate(*document, diagnostics);
    compiler.renderableElements(*document);
    fuzz::expect(!diagnostics.hasInternal(), diagnostics.text());

    // Upgrading removes elements: only what was read as it stands keeps its numbers. So the first text is the measure.
    const std::string text = doc::write(*document);
    Diagnostics rereading;
    const auto again = compiler.read("fuzz.mtlx", text, none, rereading);
    fuzz::expect(again != nullptr, rereading.text() + text);
    const std::string more = doc::write(*again);
    fuzz::expect(more == text, text + "\nbecame\n" + more);
    Diagnostics last;
    const auto third = compiler.read("fuzz.mtlx", more, none, last);
    fuzz::expect(third && same(*again, *third), "the same text, but not the same document:\n" + more);
    return 0;
}
