// The command that writes shaders.
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include "apps/cli/files.h"
#include "apps/cli/session.h"
#include "oracle/threads.h"

namespace shaderx::cli {

namespace {

// What to compile of a document, and the names of its files.
struct Work {
    std::string file;
    std::unique_ptr<doc::Document> document = nullptr;
    std::vector<doc::ElementId> elements = {};
    std::vector<std::string> stems = {};
};

void read(Session& s, Work& work, KeptFiles* kept = nullptr) {
    work.document = s.read(work.file, kept);
    if (!work.document) return;
    work.elements = s.elements(*work.document);
    for (doc::ElementId e : work.elements)
        work.stems.push_back(stemOf(work.file) + "." + fileNameOf(work.document->path(e)));
}

bool writesFiles(const Options& options) { return options.dump.empty() && options.out != "-"; }

// Two elements of one file name are an error for both, so all names are known before anything is written.
void dropClashes(Session& s, Work& work, const std::map<std::string, int>& names) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < work.elements.size(); i++) {
        if (writesFiles(s.options) && names.at(work.stems[i]) > 1) {
            Diagnostics diagnostics;
            Diagnostic& e =
                diagnostics.error("file-name-clash", "another element would be written to '" + work.stems[i] + "' too");
            e.where = work.document->locate(work.elements[i]);
            e.path = work.document->path(work.elements[i]);
            s.report(diagnostics);
            continue;
        }
        work.elements[left] = work.elements[i];
        std::swap(work.stems[left++], work.stems[i]);
    }
    work.elements.resize(left);
    work.stems.resize(left);
}

void write(Session& s, const std::string& stem, const Shader& shader) {
    if (s.options.out == "-") {
        s.print(shader.vertex + "\n" + shader.pixel);
        return;
    }
    Diagnostics diagnostics;
    std::string base = (std::filesystem::path(s.options.out) / stem).string();
    const std::string reflection = shader.reflection();
    const std::pair<const char*, std::string_view> files[] = {
        {".vert", shader.vertex}, {".frag", shader.pixel}, {".json", reflection}};
    std::size_t written = 0;
    while (written < std::size(files) && writeFile(base + files[written].first, files[written].second, diagnostics))
        written++;
    for (std::size_t i = 0; written < std::size(files) && i < written; i++)
        std::remove((base + files[i].first).c_str());
    s.report(diagnostics);
}

// Compiles some elements of a document that the session has read, and writes them.
void compile(Session& s, const Work& work, const doc::Document& document, std::size_t first, std::size_t count) {
    std::size_t next = first;
    s.compiler.generate(document, std::span(work.elements).subspan(first, count), s.how(),
                        [&](doc::ElementId e, Result<Shader> shader, const Diagnostics& diagnostics) {
                            s.reportElement(work.file, document, e, diagnostics);
                            if (shader && s.options.dump.empty()) write(s, work.stems[next], *shader);
                            next++;
                        });
}

// By one thread, document by document.
void generateInTurn(Session& s) {
    std::vector<Work> all;
    std::map<std::string, int> names;
    for (const std::string& file : s.options.files) {
        Work& work = all.emplace_back(Work{file});
        read(s, work);
        for (const std::string& stem : work.stems) names[stem]++;
        if (!work.document) all.pop_back();
    }
    for (Work& work : all) {
        dropClashes(s, work, names);
        compile(s, work, *work.document, 0, work.elements.size());
    }
}

// By several threads, each with a session and so a compiler of its own: first all read documents, then all compile
// elements, those of their own documents first. What they have to say is said in the order of one thread.
class Together {
  public:
    Together(Session& front, std::size_t threads) : front_(front), threads_(threads) {}

    void run() {
        for (const std::string& file : front_.options.files) {
            Shared& shared = all_.emplace_back();
            shared.work.file = file;
            if (file == "-") readStandardInput(shared);
        }
        sessions_.resize(threads_);
        own_.resize(threads_);
        oracle::runThreads(std::min(threads_, all_.size()), [this](std::size_t thread) { readSome(thread); });
        std::map<std::string, int> names;
        for (Shared& shared : all_) {
            front_.say(shared.reading);
            for (const std::string& stem : shared.work.stems) names[stem]++;
        }
        for (Shared& shared : all_) {
            if (!shared.work.document) continue;
            Part& clashes = parts_.emplace_back(shared);
            clashes.isDone = true;
            Session& owner = *sessions_[shared.owner];
            owner.keepIn(clashes.saying);
            dropClashes(owner, shared.work, names);
            divide(shared);
        }
        oracle::runThreads(std::min(threads_, std::max<std::size_t>(parts_.size(), 1)),
                           [this](std::size_t thread) { compileSome(thread); });
        sayWhatIsDone();
    }

  private:
    // A document, and which thread has read it.
    struct Shared {
        Work work = {};
        KeptFiles files = {};
        Later reading = {};
        std::size_t owner = 0;
    };
    // Some elements of a document.
    struct Part {
        explicit Part(Shared& s, std::size_t f = 0, std::size_t n = 0) : shared(s), first(f), count(n) {}
        Shared& shared;
        std::size_t first, count;
        Later saying = {};
        bool isDone = false;
    };

    // It can be read but once, and in the order of the command line.
    void readStandardInput(Shared& shared) {
        Diagnostics none;
        std::string text;
        if (readInput("-", text, none, front_.limits.read.maxFileBytes)) shared.files.text = std::move(text);
    }

    // What is wrong with libraries and options is told already.
    Session& sessionOf(std::size_t thread) {
        if (!sessions_[thread]) {
            sessions_[thread] = std::make_unique<Session>(front_.options);
            Later told;
            sessions_[thread]->keepIn(told);
            sessions_[thread]->start();
        }
        return *sessions_[thread];
    }

    void readSome(std::size_t thread) {
        Session& session = sessionOf(thread);
        while (Shared* shared = nextUnread()) {
            shared->owner = thread;
            session.keepIn(shared->reading);
            read(session, shared->work, &shared->files);
        }
    }

    Shared* nextUnread() {
        const std::lock_guard hold(mutex_);
        return unread_ < all_.size() ? &all_[unread_++] : nullptr;
    }

    // Elements of one document have much in common, which a part makes once. So parts are as large as lets every
    // thread have a few.
    void divide(Shared& shared) {
        const std::size_t n = shared.work.elements.size(), most = 4 * threads_;
        const std::size_t size = std::max<std::size_t>((n + most - 1) / most, 1);
        for (std::size_t first = 0; first < n; first += size) {
            parts_.emplace_back(shared, first, std::min(size, n - first));
            own_[shared.owner].push_back(&parts_.back());
        }
    }

    void compileSome(std::size_t thread) {
        Session& session = sessionOf(thread);
        std::unique_ptr<doc::Document> other;  // the last one that another thread has read
        const Shared* whose = nullptr;
        while (Part* part = nextPart(thread)) {
            session.keepIn(part->saying);
            const doc::Document* document = part->shared.work.document.get();
            if (part->shared.owner != thread) {
                if (whose != &part->shared) other = session.readAgain(part->shared.work.file, part->shared.files);
                whose = &part->shared;
                document = other.get();
            }
            if (document) compile(session, part->shared.work, *document, part->first, part->count);
            const std::lock_guard hold(mutex_);
            part->isDone = true;
            sayWhatIsDone();
        }
    }

    // The first part that is left of the thread's own documents; else the last of the thread that has most left.
    Part* nextPart(std::size_t thread) {
        const std::lock_guard hold(mutex_);
        Part* part = nullptr;
        if (!own_[thread].empty()) {
            part = own_[thread].front();
            own_[thread].pop_front();
        } else {
            auto busiest = std::max_element(own_.begin(), own_.end(),
                                            [](const auto& a, const auto& b) { return a.size() < b.size(); });
            if (busiest->empty()) return nullptr;
            part = busiest->back();
            busiest->pop_back();
        }
        return part;
    }

    void sayWhatIsDone() {
        while (said_ < parts_.size() && parts_[said_].isDone) {
            Later& saying = parts_[said_++].saying;
            front_.say(saying);
            saying = {};
        }
    }

    Session& front_;
    std::size_t threads_;
    std::vector<std::unique_ptr<Session>> sessions_ = {};  // outlive the documents
    std::deque<Shared> all_ = {};
    std::deque<Part> parts_ = {};              // in the order in which they speak
    std::vector<std::deque<Part*>> own_ = {};  // by thread: what is left of its documents
    std::size_t unread_ = 0, said_ = 0;
    std::mutex mutex_ = {};
};

}  // namespace

int generate(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    if (writesFiles(options)) {
        Diagnostics diagnostics;
        if (!makeFolder(options.out, diagnostics) && !s.report(diagnostics)) return kInputErrors;
    }
    const std::size_t threads = options.jobs < 0 ? 1 : oracle::threadCount(options.jobs, kMostThreads);
    if (threads == 1)
        generateInTurn(s);
    else
        Together(s, threads).run();
    return s.exitCode();
}

}  // namespace shaderx::cli
