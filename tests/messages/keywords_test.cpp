// SPDX-License-Identifier: BSD-3-Clause
// lcm-gen writes a field's name as it stands into every language: one that is a keyword there makes the whole
// package impossible to import.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

std::set<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

const std::map<std::string, std::set<std::string>> kKeywords = {
    {"Python", words("False None True and as assert async await break class continue def del elif else "
                     "except exec finally "
                     "for from global if import in is lambda match nonlocal not or pass print raise return "
                     "try while with "
                     "yield")},
    {"Lua 5.2",
     words("and break do else elseif end false for function goto if in local nil not or repeat return "
           "then true until while")},
    {"C",
     words("asm auto bool break case char const constexpr continue default do double else enum extern false "
           "float for goto if inline int long nullptr register restrict return short signed sizeof static "
           "struct switch thread_local true typedef typeof union unsigned void volatile while")},
    {"Java",
     words("abstract assert boolean break byte case catch char class const continue default do double "
           "else enum extends false final finally float for goto if implements import instanceof int "
           "interface long native new null package private protected public return short static strictfp "
           "super switch synchronized this throw throws transient true try var void volatile while")}};

/// Names of fields and constants of a .lcm file.
std::set<std::string> names_in(const std::string& text) {
    std::set<std::string> names;
    const std::string code = std::regex_replace(text, std::regex("//[^\n]*"), "");
    const std::regex declaration("\\s(?:const\\s+)?[\\w.]+\\s+(\\w+[^;{}]*);");
    for (std::sregex_iterator at(code.begin(), code.end(), declaration), end; at != end; ++at) {
        const std::string declared =
            std::regex_replace((*at)[1].str(), std::regex("\\[[^\\]]*\\]|=[^,]*"), "");
        for (const std::string& name : words(std::regex_replace(declared, std::regex(","), " ")))
            names.insert(name);
    }
    return names;
}

TEST(MessageTypes, NoFieldIsAKeywordOfALanguageThatLcmGenWrites) {
    EXPECT_EQ(
        names_in("package p;\nstruct t {\n  float from[3], to;  // end\n  const int8_t A = 1, B = 2;\n}\n"),
        (std::set<std::string>{"from", "to", "A", "B"}));
    std::size_t fields = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PLANEMAP_SOURCE "/lcmtypes")) {
        if (entry.path().extension() != ".lcm") continue;
        for (const std::string& name : names_in(read_file(entry.path()))) {
            ++fields;
            for (const auto& [language, keywords] : kKeywords)
                EXPECT_FALSE(keywords.contains(name))
                    << entry.path().filename() << ": " << name << " is a keyword of " << language;
        }
    }
    EXPECT_GT(fields, 150u);
}

}  // namespace
}  // namespace planemap
