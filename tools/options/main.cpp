// SPDX-License-Identifier: BSD-3-Clause
// write_options_document FILE: writes docs/options.md; for `ninja options_document`.
#include <cstdio>
#include <exception>

#include "core/files.hpp"
#include "options/options_document.hpp"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "write_options_document: give the file to write\n");
        return 2;
    }
    try {
        planemap::write_file(argv[1], planemap::options_document());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "write_options_document: %s\n", error.what());
        return 1;
    }
    return 0;
}
