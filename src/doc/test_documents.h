// What the tests of this room share: a small library of node definitions, and includes that live in memory.
#pragma once

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "doc/definitions.h"
#include "doc/read.h"

namespace shaderx::doc {

inline constexpr const char* kTestLibrary = R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodedef name="ND_constant_color3" node="constant"><input name="value" type="color3" value="0, 0, 0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_constant_float" node="constant"><input name="value" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_add_float" node="add"><input name="in1" type="float" value="0"/><input name="in2" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_add_color3" node="add"><input name="in1" type="color3" value="0, 0, 0"/><input name="in2" type="color3" value="0, 0, 0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_add_color3FA" node="add"><input name="in1" type="color3" value="0, 0, 0"/><input name="in2" type="float" value="0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_mix_color3" node="mix"><input name="fg" type="color3" value="0, 0, 0"/><input name="bg" type="color3" value="0, 0, 0"/><input name="mix" type="float" value="0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_separate3_color3" node="separate3"><input name="in" type="color3" value="0, 0, 0"/><output name="outr" type="float"/><output name="outg" type="float"/><output name="outb" type="float"/></nodedef>
  <nodedef name="ND_image_color3" node="image"><input name="file" type="filename" value="" uniform="true"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_plastic_100" node="plastic" version="1.0.0"><input name="base" type="float" value="0.8"/><input name="base_color" type="color3" value="1, 1, 1"/><input name="roughness" type="float" value="0.2"/><output name="out" type="surfaceshader"/></nodedef>
  <nodedef name="ND_plastic" node="plastic" version="1.0.1" isdefaultversion="true" inherit="ND_plastic_100"><input name="base" type="float" value="1"/><input name="sheen" type="float" value="0"/></nodedef>
  <nodedef name="ND_surfacematerial" node="surfacematerial"><input name="surfaceshader" type="surfaceshader" value=""/><output name="out" type="material"/></nodedef>
  <implementation name="IM_add" node="add" sourcecode="{{in1}} + {{in2}}"/>
  <implementation name="IM_mix" nodedef="ND_mix_color3" file="mix.sl" function="mix_color3"/>
  <implementation name="IM_mix_special" nodedef="ND_mix_color3" file="mix.x" target="special"/>
  <implementation name="IM_plastic" nodedef="ND_plastic_100" nodegraph="NG_plastic"/>
  <nodegraph name="NG_plastic"><output name="out" type="surfaceshader"/></nodegraph>
</materialx>
)";

// Files by name; an include is relative to the including file's directory.
struct MemoryFiles final : Resolver {
    std::map<std::string, std::string> files;
    std::optional<ResolvedFile> resolve(std::string_view href, std::string_view from) override {
        std::string path = normalPath(from.empty() ? std::string(href) : std::string(from) + "/" + std::string(href));
        auto at = files.find(path);
        if (at == files.end()) return {};
        return ResolvedFile{path, directoryOf(path), at->second};
    }
};

// Reads a text that must be right.
inline void readInto(Document& d, const std::string& text, const char* file = "test.mtlx") {
    Diagnostics diagnostics;
    NoIncludes none;
    ASSERT_TRUE(static_cast<bool>(read(d, file, text, none, diagnostics))) << diagnostics.text();
}

inline std::string wrap(const std::string& body, const char* version = "1.39") {
    return "<materialx version=\"" + std::string(version) + "\">" + body + "</materialx>";
}

}  // namespace shaderx::doc
