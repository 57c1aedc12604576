// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_camera/private_folder.hpp"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace planemap::virtual_camera {

namespace {

/// Where the dynamic linker finds OpenNI2.
std::filesystem::path openni2_library() {
    void* const library = dlopen("libOpenNI2.so.0", RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr)
        throw std::runtime_error(std::string(dlerror()) + "; apt-get install libopenni2-0");
    link_map* map = nullptr;
    dlinfo(library, RTLD_DI_LINKMAP, static_cast<void*>(&map));
    const std::filesystem::path file = std::filesystem::canonical(map->l_name);
    dlclose(library);
    return file;
}

}  // namespace

PrivateFolder::PrivateFolder(const std::filesystem::path& driver) {
    if (!std::filesystem::exists(driver))
        throw std::runtime_error(driver.string() + ": the virtual camera's driver is missing");
    const std::filesystem::path library = openni2_library();
    std::string pattern = (std::filesystem::temp_directory_path() / "planemap-camera-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error(pattern + ": cannot be made");
    path_ = pattern;
    const std::filesystem::path drivers = path_ / "OpenNI2/Drivers";
    std::filesystem::create_directories(drivers);
    // OpenNI2 looks for its drivers beside the file itself: a link would not do.
    std::filesystem::copy_file(library, path_ / "libOpenNI2.so.0");
    std::filesystem::create_symlink(std::filesystem::canonical(driver), drivers / driver.filename());
    const std::filesystem::path player = library.parent_path() / "OpenNI2/Drivers/libOniFile.so.0";
    if (std::filesystem::exists(player)) std::filesystem::copy_file(player, drivers / player.filename());
}

PrivateFolder::~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace planemap::virtual_camera
