// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

int main(int argc, char** argv) {
    planemap::Process process("graph", "Keyframes to loop closures and an optimised trajectory.");
    planemap::GraphOptions options;
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::Bus& bus) {
        return std::make_unique<planemap::GraphShell>(bus, options, planemap::Optimising::kInBackground);
    });
}
