// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace planemap {

/// Folder of the sample data, as the tests find it: $PLANEMAP_DATA, or ../shared/data beside the source.
std::filesystem::path default_data_folder();

}  // namespace planemap
