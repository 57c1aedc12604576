# SPDX-License-Identifier: BSD-3-Clause
# How every target of the project is compiled: warnings, instruction set, sanitizers.

# planemap_options: link it PRIVATE to each of our own targets, as $<BUILD_INTERFACE:planemap_options> where one is installed.
add_library(planemap_options INTERFACE)
target_include_directories(planemap_options INTERFACE ${CMAKE_SOURCE_DIR}/modules)
# clang builds the sanitizers only, and what it calls -Wconversion holds more.
target_compile_options(planemap_options INTERFACE -Wall -Wextra
    "$<$<CXX_COMPILER_ID:GNU>:-Wconversion;-Werror>")

# The instruction set is global: Eigen's alignment must be the same in every file that shares a type.
if(PLANEMAP_NATIVE)
    add_compile_options(-march=native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    add_compile_options(-march=${PLANEMAP_ARCH})
endif()
# Eigen aligns to 16 bytes whatever the instruction set, as Debian's PCL, Ceres and OpenCV were built to.
add_compile_definitions(EIGEN_MAX_ALIGN_BYTES=16)
# No fused multiply-add behind the reader's back: the same bytes out on every machine. Eigen fuses by hand where arm64 says
# that it can.
add_compile_options(-ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    add_compile_options(-U__ARM_FEATURE_FMA)
endif()

# A tenth of GCC's time goes into collecting garbage that a file's own memory, half a gigabyte, has room for.
add_compile_options("$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>")

if(PLANEMAP_SANITIZE)
    add_compile_options(-fsanitize=${PLANEMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -g1)
    if(PLANEMAP_SANITIZE MATCHES "address.*undefined")
        # A third of the time to compile Eigen; what they find beyond the address sanitizer is alignment.
        add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
    endif()
    add_link_options(-fsanitize=${PLANEMAP_SANITIZE})
endif()

# Most of what compiling takes is reading Eigen and the standard library, so that is done once. A precompiled header
# belongs to one way of generating code: libraries are -fPIC, tests -fPIE.
option(PLANEMAP_PRECOMPILE "Precompile the headers that nearly all files include" ON)
function(planemap_precompiled name)
    cmake_parse_arguments(ARG "" "" "HEADERS;LIBS;OPTIONS" ${ARGN})
    if(PLANEMAP_PRECOMPILE)
        file(WRITE ${CMAKE_BINARY_DIR}/generated/${name}.cpp.new "// Nothing but its precompiled header.\n")
        file(COPY_FILE ${CMAKE_BINARY_DIR}/generated/${name}.cpp.new ${CMAKE_BINARY_DIR}/generated/${name}.cpp ONLY_IF_DIFFERENT)
        add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
        target_link_libraries(${name} PRIVATE planemap_options Eigen3::Eigen ${ARG_LIBS})
        target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
        target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory>
            <optional> <random> <set> <string> <thread> <vector> <Eigen/Dense> ${ARG_HEADERS})
    endif()
endfunction()
function(planemap_use_precompiled target name)
    if(TARGET ${name})
        # GCC 12 warns of copies of strings in vain once their header is precompiled.
        target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow>")
        target_precompile_headers(${target} REUSE_FROM ${name})
    endif()
endfunction()

# What files share is read once, and names that two files of a library both use are errors, even of their own: for builds
# that are checked and thrown away. A file with options of its own stays alone.
option(PLANEMAP_UNITY "Compile the files of a library a dozen at a time" OFF)

# planemap_library(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): a static library. Those of modules/ are installed;
# to other projects planemap_<module> is planemap::<module>.
function(planemap_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/modules>)
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE $<BUILD_INTERFACE:planemap_options> ${ARG_PRIVATE})
    planemap_use_precompiled(${name} planemap_precompiled)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${PLANEMAP_UNITY} UNITY_BUILD_BATCH_SIZE 12)
    cmake_path(IS_PREFIX planemap_MODULES_DIR ${CMAKE_CURRENT_SOURCE_DIR} is_of_a_module)
    if(is_of_a_module)
        planemap_install_library(${name})
    endif()
endfunction()

set(planemap_MODULES_DIR ${CMAKE_SOURCE_DIR}/modules)
function(planemap_install_library name)
    string(REGEX REPLACE "^planemap_" "" exported ${name})
    set_target_properties(${name} PROPERTIES EXPORT_NAME ${exported})
    install(TARGETS ${name} EXPORT planemap COMPONENT dev ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/planemap)
endfunction()

# planemap_program(NAME SOURCES... LIBS... [COMPONENT of the packages, default runtime]): an executable in build/bin.
function(planemap_program name)
    cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;LIBS" ${ARGN})
    if(NOT ARG_COMPONENT)
        set(ARG_COMPONENT runtime)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE planemap_options ${ARG_LIBS})
    target_link_options(${name} PRIVATE -Wl,--as-needed)  # a robot installs what is used
    install(TARGETS ${name} COMPONENT ${ARG_COMPONENT} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()
