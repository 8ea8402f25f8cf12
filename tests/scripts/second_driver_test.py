#!/usr/bin/env python3
"""tests/scripts/second_driver_test.py AIRLIGHT: `airlight doctor --check` on Mesa's zink over its Vulkan software driver.

A second driver reads the shaders with another compiler. Debian package: mesa-vulkan-drivers. Without it the test is skipped.
"""
import glob
import os
import subprocess
import sys
import tempfile


def skip(why):
    print("test skipped: " + why)
    sys.exit(0)


def main():
    drivers = sorted(glob.glob("/usr/share/vulkan/icd.d/lvp_icd*.json"))
    if not drivers:
        skip("there is no second driver (Debian package mesa-vulkan-drivers)")
    with tempfile.TemporaryDirectory() as folder:
        # gpu/README.md says what the variables are for.
        environment = dict(os.environ, VK_ICD_FILENAMES=drivers[0], LIBGL_ALWAYS_SOFTWARE="1", GALLIUM_DRIVER="zink",
                           ZINK_INLINE_UNIFORMS="0", XDG_CACHE_HOME=folder, XDG_RUNTIME_DIR=folder)
        for variable in ("AIRLIGHT_GPU", "AIRLIGHT_DUMP_SHADERS"):
            environment.pop(variable, None)
        check = subprocess.run([sys.argv[1], "doctor", "--check", "--gpu", "zink"], env=environment, capture_output=True, text=True)
    print(check.stdout + check.stderr)
    if check.returncode == 3:
        skip("Mesa has no zink here")
    if check.returncode != 0:
        sys.exit("the second driver failed: exit code %d" % check.returncode)


if __name__ == "__main__":
    main()
