// SPDX-License-Identifier: MIT
// Stands in for an older version of a kit's library, as far as plug-ins query it: preloaded, it
// answers before the real one.
extern "C" __attribute__((visibility("default"))) const char* OSGSKIN_OTHER_KIT();

extern "C" const char* OSGSKIN_OTHER_KIT() {
    return "0.1.7 (00000000)";
}
