// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("graph", "Keyframes to loop closures and an optimised trajectory.");
    planemap::graph::GraphOptions options;
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        return std::make_unique<planemap::graph::GraphShell>(bus, options,
                                                             planemap::graph::Optimising::kInBackground);
    });
}
