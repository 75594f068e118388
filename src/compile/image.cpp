// A library as one block of 32-bit words that is used in place.
//
// Header: magic, version, count of words, then for each section its first word and its count of words. Texts and plain
// structures lie as they are in memory, so an image serves machines of the byte order and layout that made it; it is
// made by the build that uses it.
#include <bit>
#include <cstring>

#include "compile/library.h"

namespace shaderx {

namespace {

constexpr std::uint32_t kMagic = 0x53584c42, kVersion = 3;

enum Section : std::uint32_t {
    NameEnds,
    NameSlots,
    NameBytes,
    Elements,
    Attributes,
    NodeDefs,
    DefNames,
    Ports,
    Implementations,
    Declarations,
    FunctionNames,  // sorted by name: name, first word in Functions
    Functions,
    Signatures,
    Leaves,
    kSections,
};
constexpr std::size_t kHeader = 3 + 2 * kSections;

using Words = std::vector<std::uint32_t>;

template <class T>
void append(Words& to, std::span<const T> values) {
    std::size_t bytes = values.size_bytes(), at = to.size();
    to.resize(at + (bytes + 3) / 4, 0);
    if (bytes) std::memcpy(to.data() + at, values.data(), bytes);
}

// A block of an image as an array; empty if it does not fit.
struct Block {
    std::span<const std::uint32_t> words;
    template <class T>
    std::span<const T> as() const {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 4);
        return {reinterpret_cast<const T*>(words.data()), words.size() * 4 / sizeof(T)};
    }
};

// A row in FunctionNames, Signatures and so on are read and written in turn by these two.
struct Sink {
    Words& out;
    void word(std::uint32_t w) { out.push_back(w); }
    void params(std::span<const ir::Param> ps) {
        word(static_cast<std::uint32_t>(ps.size()));
        for (const ir::Param& p : ps) {
            word(p.name.index);
            word(static_cast<std::uint32_t>(p.type));
        }
    }
    template <class T>
    void array(const std::vector<T>& values) {
        word(static_cast<std::uint32_t>(values.size()));
        append<T>(out, values);
    }
};

struct Reader {
    std::span<const std::uint32_t> in;
    std::size_t at = 0;
    std::uint32_t word() { return at < in.size() ? in[at++] : 0; }
    std::vector<ir::Param> params() {
        std::vector<ir::Param> ps(word());
        for (ir::Param& p : ps) {
            p.name = Name(word());
            p.type = static_cast<ir::Type>(word());
        }
        return ps;
    }
    template <class T>
    std::vector<T> array() {
        std::size_t n = word(), words = (n * sizeof(T) + 3) / 4;
        std::vector<T> values(n);
        if (n) std::memcpy(static_cast<void*>(values.data()), in.data() + at, n * sizeof(T));
        at += words;
        return values;
    }
};

void writeFunction(Sink s, const ir::Function& f) {
    s.word(f.name.index);
    s.params(f.params);
    s.word(static_cast<std::uint32_t>(f.results.size()));
    for (const ir::ResultValue& r : f.results) {
        s.word(r.name.index);
        s.word(static_cast<std::uint32_t>(r.type));
        s.word(r.value.index);
    }
    s.array(f.exprs);
    s.array(f.operands);
    s.array(f.words);
    s.array(f.hints);
    s.word(f.loops);
    s.word(f.isInline | f.isApart << 1);
    s.array(std::vector<char>(f.comment.begin(), f.comment.end()));
}

ir::Function readFunction(Reader r) {
    ir::Function f;
    f.name = Name(r.word());
    f.params = r.params();
    f.results.resize(r.word());
    for (ir::ResultValue& v : f.results) {
        v.name = Name(r.word());
        v.type = static_cast<ir::Type>(r.word());
        v.value = ir::ExprId(r.word());
    }
    f.exprs = r.array<ir::Expr>();
    f.operands = r.array<ir::ExprId>();
    f.words = r.array<std::uint32_t>();
    f.hints = r.array<Name>();
    f.loops = r.word();
    const std::uint32_t flags = r.word();
    f.isInline = flags & 1;
    f.isApart = flags & 2;
    std::vector<char> comment = r.array<char>();
    f.comment.assign(comment.begin(), comment.end());
    return f;
}

// The sections of an image; empty if the bytes are none.
std::vector<Block> sectionsOf(std::span<const std::uint8_t> image) {
    std::vector<Block> sections;
    if (image.size() < kHeader * 4 || reinterpret_cast<std::uintptr_t>(image.data()) % 4) return sections;
    std::span<const std::uint32_t> words(reinterpret_cast<const std::uint32_t*>(image.data()), image.size() / 4);
    if (words[0] != kMagic || words[1] != kVersion || words[2] != words.size()) return sections;
    for (std::size_t i = 0; i < kSections; i++) {
        std::size_t first = words[3 + 2 * i], count = words[4 + 2 * i];
        if (first > words.size() || count > words.size() - first) return {};
        sections.push_back({words.subspan(first, count)});
    }
    return sections;
}

NameImage nameImage(const std::vector<Block>& s) {
    auto ends = s[NameEnds].words;
    std::string_view bytes(reinterpret_cast<const char*>(s[NameBytes].words.data()), ends.empty() ? 0 : ends.back());
    return {ends, s[NameSlots].words, bytes};
}

class ImageLibrary final : public Library {
  public:
    ImageLibrary(NameTable& names, std::vector<Block> sections)
        : sections_(std::move(sections)),
          document_(names, sections_[Elements].as<doc::Element>(), sections_[Attributes].as<doc::Attribute>()) {
        Reader r{sections_[Leaves].words};
        leaves_.resize(r.word());
        for (ir::LeafInfo& l : leaves_) {
            l.name = Name(r.word());
            l.params = r.params();
        }
    }

    const doc::Document& document() const override { return document_; }
    doc::DefinitionsIndex index() const override {
        return {sections_[NodeDefs].as<doc::NodeDefRow>(), sections_[DefNames].as<doc::NameRow>(),
                sections_[Ports].as<doc::Port>(), sections_[Implementations].as<doc::ImplementationRow>(),
                sections_[Declarations].as<doc::ElementId>()};
    }

    const std::vector<sl::Signature>& signatures() override {
        if (!signatures_.empty()) return signatures_;
        Reader r{sections_[Signatures].words};
        signatures_.resize(r.word());
        for (sl::Signature& s : signatures_) {
            s.name = Name(r.word());
            s.plainName = Name(r.word());
            s.result = static_cast<ir::Type>(r.word());
            s.params = r.params();
            s.outputs = r.params();
        }
        return signatures_;
    }

    const ir::Function* find(Name name) override {
        if (auto it = decoded_.find(name); it != decoded_.end()) return it->second.get();
        auto rows = sections_[FunctionNames].as<doc::NameRow>();
        std::size_t low = 0, high = rows.size();
        while (low < high) {
            std::size_t middle = (low + high) / 2;
            (rows[middle].name < name ? low : high) = rows[middle].name < name ? middle + 1 : middle;
        }
        if (low == rows.size() || rows[low].name != name) return nullptr;
        auto f = std::make_unique<ir::Function>(readFunction({sections_[Functions].words.subspan(rows[low].row)}));
        return (decoded_[name] = std::move(f)).get();
    }

    const ir::LeafInfo* findLeaf(Name name) override {
        for (const ir::LeafInfo& l : leaves_)
            if (l.name == name) return &l;
        return nullptr;
    }

    std::vector<const ir::Function*> functions() const override { return {}; }

  private:
    std::vector<Block> sections_;
    doc::Document document_;
    std::vector<ir::LeafInfo> leaves_;
    std::vector<sl::Signature> signatures_;
    std::unordered_map<Name, std::unique_ptr<ir::Function>> decoded_;
};

void writeNames(std::vector<Words>& sections, const NameTable& names) {
    std::string bytes;
    std::size_t slots = std::bit_ceil(std::size_t(names.size()) * 2 + 2);
    Words& table = sections[NameSlots];
    table.assign(slots, 0);
    for (std::uint32_t i = 0; i < names.size(); i++) {
        std::string_view text = names.text(Name(i));
        bytes += text;
        sections[NameEnds].push_back(static_cast<std::uint32_t>(bytes.size()));
        std::size_t slot = hashText(text) & (slots - 1);
        while (table[slot]) slot = (slot + 1) & (slots - 1);
        table[slot] = i + 1;
    }
    append<char>(sections[NameBytes], std::span<const char>(bytes.data(), bytes.size()));
}

}  // namespace

NameImage namesOf(std::span<const std::uint8_t> image) {
    std::vector<Block> sections = sectionsOf(image);
    return sections.empty() ? NameImage{} : nameImage(sections);
}

std::unique_ptr<Library> openLibrary(NameTable& names, std::span<const std::uint8_t> image) {
    std::vector<Block> sections = sectionsOf(image);
    if (sections.empty()) return nullptr;
    return std::make_unique<ImageLibrary>(names, std::move(sections));
}

std::vector<std::uint8_t> writeImage(const Library& library, std::span<const sl::Signature> signatures,
                                     std::span<const ir::Function* const> functions,
                                     std::span<const ir::LeafInfo> leaves, const NameTable& names) {
    std::vector<Words> sections(kSections);
    writeNames(sections, names);
    // Comments and lines are for people: elements lose their places, which have no text behind them here.
    std::vector<doc::Element> elements(library.document().elements().begin(), library.document().elements().end());
    for (doc::Element& e : elements) {
        e.source = doc::Element::kNoSource;
        e.offset = 0;
    }
    append<doc::Element>(sections[Elements], elements);
    append<doc::Attribute>(sections[Attributes], library.document().allAttributes());
    doc::DefinitionsIndex index = library.index();
    append(sections[NodeDefs], index.nodedefs);
    append(sections[DefNames], index.names);
    append(sections[Ports], index.ports);
    append(sections[Implementations], index.implementations);
    append(sections[Declarations], index.declarations);
    for (const ir::Function* f : functions) {  // sorted by name
        sections[FunctionNames].push_back(f->name.index);
        sections[FunctionNames].push_back(static_cast<std::uint32_t>(sections[Functions].size()));
        writeFunction({sections[Functions]}, *f);
    }
    Sink s{sections[Signatures]};
    s.word(static_cast<std::uint32_t>(signatures.size()));
    for (const sl::Signature& g : signatures) {
        s.word(g.name.index);
        s.word(g.plainName.index);
        s.word(static_cast<std::uint32_t>(g.result));
        s.params(g.params);
        s.params(g.outputs);
    }
    Sink l{sections[Leaves]};
    l.word(static_cast<std::uint32_t>(leaves.size()));
    for (const ir::LeafInfo& leaf : leaves) {
        l.word(leaf.name.index);
        l.params(leaf.params);
    }
    Words image(kHeader);
    image[0] = kMagic;
    image[1] = kVersion;
    for (std::size_t i = 0; i < kSections; i++) {
        image[3 + 2 * i] = static_cast<std::uint32_t>(image.size());
        image[4 + 2 * i] = static_cast<std::uint32_t>(sections[i].size());
        image.insert(image.end(), sections[i].begin(), sections[i].end());
    }
    image[2] = static_cast<std::uint32_t>(image.size());
    const std::uint8_t* bytes = reinterpret_cast<const std::uint8_t*>(image.data());
    return {bytes, bytes + image.size() * 4};
}

}  // namespace shaderx
