// The functions of the node library as subjects: those of its sources and the bodies of its nodes.
#pragma once

#include <memory>

#include "compile/bodies.h"
#include "compile/library.h"
#include "table/check.h"

namespace shaderx::table {

// The node library, read from its files, and everything that is to be tested of it.
struct NodeLibrary {
    explicit NodeLibrary(NameTable& names);

    std::unique_ptr<Library> library;
    doc::Definitions definitions;
    std::unique_ptr<NodeBodies> bodies;
    Diagnostics diagnostics;
};

// A function that is not tested, and why.
struct Exempt {
    std::string name, reason;
};

// Subjects for every function of the library, several where strings choose what it does. Functions whose strings are
// given are added to `program`, which finds the others in its sources.
std::vector<Subject> functions(NodeLibrary& nodes, ir::Module& program, std::vector<std::string>& names,
                               std::vector<Exempt>& exempt);

}  // namespace shaderx::table
