# SPDX-License-Identifier: MIT
"""Untested. A Conan 2 recipe of the sources that it lies in: conan create cmake/conan"""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class OsgSkin(ConanFile):
    name = "osgskin"
    description = "Skin of OpenSceneGraph characters, without painted weights"
    license = ("MIT", "GPL-3.0-or-later")
    package_type = "shared-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"bind": [True, False]}  # osgSkinBind, osgSkinCharacter, plug-in, programs: GPL
    default_options = {"bind": True, "openscenegraph/*:shared": True}

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, "../../nodekits/osgSkin/include/osgSkin/Version"))
        self.version = re.search(r'OSGSKIN_VERSION "(.*)"', header)[1]

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "../..")
        for part in ("CMakeLists.txt", "LICENSE", "LICENSES/*", "cmake/*", "data/*", "examples/*", "nodekits/*",
                     "osgPlugin/*"):
            copy(self, part, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("openscenegraph/3.6.5", transitive_headers=True, transitive_libs=True)
        self.requires("glm/0.9.9.8", transitive_headers=True)
        self.requires("highway/1.0.3")
        self.requires("onetbb/2021.12.0")
        self.requires("meshoptimizer/0.20")
        self.requires("assimp/5.4.3")
        self.requires("draco/1.5.6")
        self.requires("nlohmann_json/3.11.3")
        self.requires("stb/cci.20230920")
        if self.options.bind:
            self.requires("cgal/5.6.1")
            self.requires("eigen/3.4.0")
            self.requires("cli11/2.4.2")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.variables["OSGSKIN_BIND"] = bool(self.options.bind)
        toolchain.variables["OSGSKIN_EXAMPLES"] = bool(self.options.bind)
        toolchain.variables["OSGSKIN_TESTS"] = False
        toolchain.variables["OSGSKIN_BENCH"] = False
        # CMake's own modules find OSG; see cmake/OsgTargets.cmake.
        toolchain.variables["OSG_DIR"] = self.dependencies["openscenegraph"].package_folder.replace("\\", "/")
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE*", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # Users find the package's own configuration, osgSkinConfig.cmake.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/osgSkin"]
