#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Highway 1.0.3, Debian's libhwy.so: a program that is linked with it and calls nothing of it takes
# milliseconds of processor time more to start. One expects nothing, as of any library of functions:
# a static initialiser calibrates the timer of its benchmark code. Needs g++ and python3.
. "$(dirname "$0")/common.sh"
debian_package libhwy-dev 1.0.3-3+deb12u1
echo 'int main() {}' >empty.cpp
g++ empty.cpp -o without -Wl,--no-as-needed -lstdc++ -lm # which libhwy needs, too
g++ empty.cpp -o with -Wl,--no-as-needed -lstdc++ -lm -lhwy
cat >start.py <<'END'
import os


def milliseconds(program):
    """The least processor time of 40 starts."""
    least = 1e9
    for _ in range(40):
        pid = os.posix_spawn(program, [program], os.environ)
        _, _, used = os.wait4(pid, 0)
        least = min(least, 1e3 * (used.ru_utime + used.ru_stime))
    return least


without, with_it = milliseconds("./without"), milliseconds("./with")
print("libhwy adds more than the whole program takes without it:", with_it > 2 * without)
END
python3 start.py >seen
expect <<'END'
libhwy adds more than the whole program takes without it: True
END
