// SPDX-License-Identifier: BSD-3-Clause
// A file for --config, read by a program with options of every kind.
#include <optional>

#include "fuzz/fuzz.hpp"
#include "messages/flags.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    messages::Flags flags("planemap-fuzz", "Reads a file of options.");
    std::string text, word = "near";
    std::optional<double> number;
    std::optional<std::uint64_t> seed;
    int whole = 0;
    bool yes = false;
    simulator::SimulatorOptions simulated;
    flags.add("text", text, "Text");
    flags.add_choice("word", word, {"near", "far"}, "A word");
    flags.add("number", number, "A number");
    flags.add("seed", seed, "A seed");
    flags.add("whole", whole, "A whole number");
    flags.add("yes", yes, "Or no");
    flags.add(simulator::options_of(simulated), "sim-");
    const std::string path = file.path().string();
    const char* const arguments[] = {"planemap-fuzz", "--config", path.c_str()};
    const int code = flags.parse(3, arguments);
    require(code == -1 || code == 2, "a file of options is taken, or it is wrong");
    if (code == -1) require(word == "near" || word == "far", "a choice is one of its words");
    flags.values();
}

std::vector<std::string> seeds() {
    return {};
}

}  // namespace planemap::fuzz
