# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts where, the CMake package for other projects, and the Debian packages.
# Components: runtime (programs, spy, units for systemd and procman, the jars, the documents), dev (libraries, headers, .lcm files, the CMake package),
# benchmarks (planemap-bench-*; in no Debian package).
include(CMakePackageConfigHelpers)

install(DIRECTORY ${CMAKE_SOURCE_DIR}/modules/ COMPONENT dev DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/planemap
    FILES_MATCHING PATTERN "*.hpp")
install(PROGRAMS ${CMAKE_SOURCE_DIR}/tools/spy COMPONENT runtime DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME planemap-spy)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/tools/systemd ${CMAKE_SOURCE_DIR}/tools/procman COMPONENT runtime
    DESTINATION ${CMAKE_INSTALL_DATADIR}/planemap)
# README.md's links to docs/ hold there, too.
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_SOURCE_DIR}/LICENSE COMPONENT runtime
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/planemap)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs COMPONENT runtime DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/planemap)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE COMPONENT runtime DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/planemap RENAME copyright)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE COMPONENT dev DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/planemap-dev RENAME copyright)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples COMPONENT dev DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/planemap-dev)

# find_package(planemap): planemap::core, planemap::map, ...
set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/planemap)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/planemapConfig.cmake.in ${CMAKE_BINARY_DIR}/planemapConfig.cmake
    INSTALL_DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/planemapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/planemapConfig.cmake ${CMAKE_BINARY_DIR}/planemapConfigVersion.cmake
    ${CMAKE_SOURCE_DIR}/cmake/PlanemapLibraryDependencies.cmake COMPONENT dev DESTINATION ${PACKAGE_DIR})
install(EXPORT planemap NAMESPACE planemap:: FILE planemapTargets.cmake COMPONENT dev DESTINATION ${PACKAGE_DIR})

# `cpack --config build/CPackConfig.cmake`: planemap_VERSION_ARCH.deb and planemap-dev_VERSION_ARCH.deb.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL runtime dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "planemap maintainers <maintainers@planemap.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME planemap)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
# lcm-logger for planemap-launch --log; Java and lcm-spy only where someone looks into the bus.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS liblcm-bin)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "default-jre, liblcm-java, libjchart2d-java")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "A trajectory and a map made only of planes from RGB-D cameras over LCM: the modules as processes, planemap-run, and its tools.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME planemap-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "liblcm-dev, libeigen3-dev, libspdlog-dev, libcli11-dev, nlohmann-json3-dev, \
libopencv-dev, libceres-dev, liboctomap-dev, libturbojpeg0-dev, libdeflate-dev, libspng-dev, libopenni2-dev, libfreenect-dev")
if(PLANEMAP_PCL)
    string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libpcl-dev")
endif()
set(CPACK_COMPONENT_DEV_DESCRIPTION "Libraries, headers, LCM types and the CMake package of planemap, and examples.")
include(CPack)
