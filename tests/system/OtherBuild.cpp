// SPDX-License-Identifier: MIT
// Stands in for a kit's library of an older version, as far as plug-ins ask it: preloaded, it
// answers before the real one.
extern "C" __attribute__((visibility("default"))) const char* OSGSKIN_OTHER_KIT();

extern "C" const char* OSGSKIN_OTHER_KIT() {
    return "0.1.7 (00000000)";
}
