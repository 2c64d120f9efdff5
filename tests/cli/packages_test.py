"""The Debian packages: what is in them, a program that builds with the library's, and an installation on a bare system."""
import glob
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from support import SOURCE, CliTest

BUILD = os.environ.get("VDBSYNTH_BUILD", "")


def run(*words, **options):
    options.setdefault("timeout", 600)
    result = subprocess.run([str(w) for w in words], capture_output=True, text=True, **options)
    if result.returncode:
        raise AssertionError(f"{words} gave {result.returncode}: {(result.stdout + result.stderr)[-3000:]}")
    return result.stdout


def field(package, name):
    return run("dpkg-deb", "-f", package, name).strip()


def contents(package):
    return {line.split()[5].lstrip(".") for line in run("dpkg-deb", "-c", package).splitlines()}


class Packages(CliTest):
    @classmethod
    def setUpClass(cls):
        for tool in ("cpack", "dpkg-shlibdeps", "dpkg-deb"):
            if not shutil.which(tool):
                raise unittest.SkipTest(f"{tool} is absent")
        if not BUILD:
            raise unittest.SkipTest("VDBSYNTH_BUILD names no build folder")
        cls.place = tempfile.mkdtemp(prefix="vdbsynth_packages_")
        os.chmod(cls.place, 0o755)
        run(SOURCE / "tools/dev/make_packages.sh", "--of", BUILD, cls.place)
        cls.tool, = glob.glob(cls.place + "/vdb-synth_*.deb")
        cls.library, = glob.glob(cls.place + "/libvdbsynth-dev_*.deb")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(getattr(cls, "place", "/nowhere"), ignore_errors=True)

    def test_the_tool(self):
        depends = field(self.tool, "Depends")
        for library in ("libc6", "libstdc++6", "libopenvdb", "libtbb", "libboost-program-options"):
            self.assertIn(library, depends)
        self.assertNotIn("-dev", depends)
        files = contents(self.tool)
        for path in ("/usr/bin/vdb_synth", "/usr/share/man/man1/vdb_synth.1.gz", "/usr/share/man/man1/vdb_synth-synth.1.gz",
                     "/usr/share/bash-completion/completions/vdb_synth", "/usr/share/fish/vendor_completions.d/vdb_synth.fish",
                     "/usr/share/doc/vdb-synth/copyright"):
            self.assertIn(path, files)
        self.assertTrue([f for f in files if f.endswith("/_vdb_synth")])
        self.assertFalse([f for f in files if f.endswith((".h", ".a", ".cmake"))])
        if shutil.which("lintian"):
            said = subprocess.run(["lintian", "--allow-root", "--tag-display-limit", "0", "--fail-on", "none", self.tool],
                                  capture_output=True, text=True, timeout=400).stdout
            self.assertEqual([line for line in said.splitlines() if line.startswith("E:")], [])

    def test_the_library_builds_a_program(self):
        self.assertIn("libopenvdb-dev", field(self.library, "Depends"))
        self.assertFalse([f for f in contents(self.library) if "/bin/" in f])
        root = self.path("root")
        run("dpkg-deb", "-x", self.library, root)
        build = self.path("build")
        run("cmake", "-G", "Ninja", "-S", SOURCE / "tests/consumer", "-B", build, f"-DCMAKE_PREFIX_PATH={root}/usr")
        run("cmake", "--build", build)
        run(build + "/consumer")

    def test_the_python_module(self):
        modules = glob.glob(self.place + "/python3-vdbsynth_*.deb")
        if not modules:
            self.skipTest("the build has no Python module (VDBSYNTH_PYTHON)")
        self.assertRegex(field(modules[0], "Depends"), r"python3 \(>= 3\.\d+\), python3 \(<< 3\.\d+\), python3-numpy")
        self.assertIn("libopenvdb", field(modules[0], "Depends"))
        run("dpkg-deb", "-x", modules[0], self.path("root"))
        run("/usr/bin/python3", "-c", "import vdbsynth", cwd="/", env={**os.environ, "PYTHONPATH": self.path("root/usr/lib/python3/dist-packages")})

    def bare_system(self):
        """A system of the packages that are always there, made from the machine's own sources."""
        if os.geteuid() != 0:
            self.skipTest("only root can make a bare system")
        for tool in ("debootstrap", "chroot", "unshare"):
            if not shutil.which(tool):
                self.skipTest(f"{tool} is absent")
        with open("/etc/os-release", encoding="utf-8") as file:
            release = re.search(r"(?m)^VERSION_CODENAME=(\S+)", file.read())
        sites = subprocess.run(["apt-get", "indextargets", "--format", "$(SITE) $(CODENAME) $(COMPONENT)", "Created-By: Packages"],
                               capture_output=True, text=True).stdout.splitlines()
        site = next((line.split()[0] for line in sites if release and line.split()[1:] == [release.group(1), "main"]), None)
        if not site:
            self.skipTest("the machine's package sources are not Debian's")
        root = self.path("system")
        made = subprocess.run(["debootstrap", "--variant=minbase", release.group(1), root, site], capture_output=True, text=True, timeout=500)
        self.addCleanup(subprocess.run, ["umount", "-R", root + "/proc"], capture_output=True)
        if made.returncode:
            self.skipTest("a bare system cannot be made here: " + made.stdout.strip()[-200:])
        return root

    def test_on_a_bare_system(self):
        root = self.bare_system()
        shutil.copy(self.tool, root + "/tool.deb")

        def inside(*words):
            script = 'mount -t proc proc "$0/proc" 2>/dev/null; exec chroot "$0" "$@"'
            return run("unshare", "--mount", "--pid", "--fork", "sh", "-c", script, root, *words,
                       env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "LANG": "C.UTF-8",
                            **{name: value for name, value in os.environ.items() if name.endswith("_proxy")}})

        inside("apt-get", "-qq", "-o", "APT::Sandbox::User=root", "install", "-y", "--no-install-recommends", "/tool.deb")
        self.assertRegex(inside("vdb_synth", "--version"), r"OpenVDB \d+\.\d+\.\d+ \(libopenvdb\.so\.")
        inside("sh", "-c", "cd /root && vdb_synth make grid g.vdb --resolution 24 && vdb_synth synth g.vdb -o m.vdb -o m.obj --size 2x,1x,1x"
               " && vdb_synth render m.vdb -o m.png")
        self.assertGreater(os.path.getsize(root + "/root/m.png"), 1000)
        self.assertIn("nothing here looks wrong", inside("vdb_synth", "doctor"))
        self.assertIn("--longest-run", inside("bash", "-c", "source /usr/share/bash-completion/completions/vdb_synth; _vdb_synth_options synth"))
        inside("dpkg", "--purge", "vdb-synth")
        self.assertFalse(os.path.exists(root + "/usr/bin/vdb_synth"))


class Container(CliTest):
    def test_it_is_built_and_runs_as_process_1(self):
        """Of minutes, and not everywhere possible, so VDBSYNTH_CONTAINER asks for it. VDBSYNTH_PACKAGES names a folder of packages."""
        if not os.environ.get("VDBSYNTH_CONTAINER"):
            self.skipTest("VDBSYNTH_CONTAINER=1 builds the container")
        packages = os.environ.get("VDBSYNTH_PACKAGES", "")
        if not packages:
            if not BUILD or not shutil.which("cpack"):
                self.skipTest("VDBSYNTH_BUILD names no build folder, or cpack is absent")
            packages = self.path("packages")
            run(SOURCE / "tools/dev/make_packages.sh", "--of", BUILD, packages)
        said = run(SOURCE / "tools/dev/container.sh", "--packages", packages, timeout=1700).splitlines()
        if said[-1].startswith("skipped: "):
            self.skipTest(said[-1])
        self.assertEqual(said[-1], "built, run as process 1, stopped by SIGTERM with 143")


if __name__ == "__main__":
    unittest.main(verbosity=2)
