// SPDX-License-Identifier: BSD-3-Clause
#include "core/text_file.hpp"

#include <stdexcept>

#include "core/files.hpp"

namespace planemap {

std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::string text = read_file(file, max_bytes);
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        throw std::runtime_error(file.string() + ": UTF-16 text; save it as UTF-8");
    }
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    return text;
}

std::string shown_text(std::string_view text, std::size_t longest) {
    std::string result(text.substr(0, longest));
    for (char& c : result) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return text.size() > longest ? result + "..." : result;
}

}  // namespace planemap
