// SPDX-License-Identifier: MIT
// Part of each program that is built with the address sanitizer. OpenGL drivers leak a few hundred
// bytes per context. They are unloaded before the leak check, so their frames have no names and
// cannot be suppressed: here libraries stay loaded.
extern "C" {

__attribute__((visibility("default"))) int dlclose(void*) noexcept {
    return 0;
}

__attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
    return "leak:_dri.so\nleak:libGL\nleak:libXext\nleak:libEGL\nleak:libLLVM\nleak:libgallium\n";
}

} // extern "C"
