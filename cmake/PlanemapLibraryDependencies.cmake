# SPDX-License-Identifier: BSD-3-Clause
# What the libraries of modules/ need, from Debian's packages; read by the build and by find_package(planemap). Only what
# CMake lacks a config for is found by hand.

# find_library_target(TARGET HEADER LIBRARY [FOLDER of the header]): an imported target for a library without a CMake
# config.
function(find_library_target target header library)
    if(TARGET ${target})
        return()
    endif()
    string(MAKE_C_IDENTIFIER ${target} id)
    find_path(${id}_INCLUDE ${header} PATH_SUFFIXES ${ARGN} REQUIRED)
    find_library(${id}_LIBRARY ${library} REQUIRED)
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} SYSTEM INTERFACE ${${id}_INCLUDE})
    target_link_libraries(${target} INTERFACE ${${id}_LIBRARY})
endfunction()

# for_modules("MODULE..." COMMAND...): the command, where PLANEMAP_MODULES (empty: all) holds one of the modules, which
# need what it finds: those that are built, or that find_package(planemap) is asked for.
macro(for_modules modules command)
    foreach(needing ${modules})
        if(NOT PLANEMAP_MODULES OR "${needing}" IN_LIST PLANEMAP_MODULES)
            cmake_language(CALL ${command} ${ARGN})
            break()
        endif()
    endforeach()
endmacro()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
for_modules(messages find_package spdlog REQUIRED)
for_modules(messages find_package CLI11 REQUIRED)
for_modules("lcmtypes;messages" find_library_target lcm::lcm lcm/lcm-cpp.hpp lcm)
for_modules("messages;sensor" find_library_target turbojpeg::turbojpeg turbojpeg.h turbojpeg)
for_modules("messages;sensor;octomap" find_library_target libdeflate::libdeflate libdeflate.h deflate)
for_modules(sensor find_library_target spng::spng spng.h spng)
for_modules(camera find_library_target OpenNI2::OpenNI2 OpenNI.h OpenNI2 openni2)
for_modules(camera find_library_target freenect::freenect libfreenect.h freenect)
for_modules(odometry find_package OpenCV REQUIRED COMPONENTS core imgproc features2d video)
for_modules(graph find_package Ceres REQUIRED)
for_modules(octomap find_package octomap REQUIRED)

# PCL's own config drags in VTK, Qt and MPI; the paper's RANSAC needs four of its libraries.
if(NOT PLANEMAP_PCL OR TARGET planemap_pcl OR (PLANEMAP_MODULES AND NOT "segmentation" IN_LIST PLANEMAP_MODULES))
    return()
endif()
find_path(PCL_INCLUDE pcl/point_types.h PATH_SUFFIXES pcl-1.13 pcl-1.14 pcl-1.15 REQUIRED)
add_library(planemap_pcl INTERFACE IMPORTED GLOBAL)
target_include_directories(planemap_pcl SYSTEM INTERFACE ${PCL_INCLUDE})
foreach(part common kdtree search sample_consensus filters features segmentation)
    find_library(PCL_${part}_LIBRARY pcl_${part} REQUIRED)
    target_link_libraries(planemap_pcl INTERFACE ${PCL_${part}_LIBRARY})
endforeach()
target_link_libraries(planemap_pcl INTERFACE Eigen3::Eigen)
