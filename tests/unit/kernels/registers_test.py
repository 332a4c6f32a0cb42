#!/usr/bin/env python3
"""registers_test.py FORM SPHERULE SHADERS GLSLANG STATISTICS: registers, spills, scratch memory and size of each
kernel, as Mesa's driver RADV compiles it for an RDNA2 GPU. It needs no GPU. FORM is one of:

  largest   each kernel once, with all features of a model but some shapes of obstacles, which take long to compile
  all       each kernel with each set of features of the shipped scenes, of each model, and of scenes with everything

LIMITS has the limits. STATISTICS is the program radv_statistics. The test prints the largest figures of each kernel."""
import copy
import dataclasses
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import kernels

FORM, SPHERULE, SHADERS, GLSLANG, STATISTICS = sys.argv[-5:]
SHADERS = Path(SHADERS)
SCENES = SHADERS.parent / "server" / "scenes"
MODELS = ("balanced", "fast", "accurate")
UNIFORMS_AT = 16  # the binding of the uniform block: radv_statistics.cpp


@dataclasses.dataclass
class Limits:
    """The most that a kernel may have, and the reason if it may have more than others."""
    vgprs: int = 128  # registers of a lane: then four waves of 64 lanes fit on a SIMD, which has 512
    sgpr_spills: int = 0  # scalar registers that lie in lanes of vector registers for a time
    scratch: int = 0  # bytes of memory per invocation, for arrays with indices
    code: int = 32768  # bytes: the instruction cache
    reason: str = ""


SURFACES = "each shape and each triangle of a mesh is found in code of its own"
LEVELS = "with several levels of cells, the numbers of each level are held"
LIMITS = {
    "codec_choose.comp": Limits(scratch=3072, code=72 << 10, reason="packs a block of values in an array"),
    "finish_substep.comp": Limits(vgprs=192, sgpr_spills=24, code=56 << 10, reason=SURFACES),
    "list_build.comp": Limits(scratch=1536, reason="gathers the pairs of a group of cells in an array"),
    "solve_forces.comp": Limits(sgpr_spills=16, reason=LEVELS),
    "solve_impulses.comp": Limits(sgpr_spills=16, reason=LEVELS),
    "solve_unlisted.comp": Limits(vgprs=152, reason=LEVELS + "; runs only while lists have no room"),
    "statistics_spheres.comp": Limits(vgprs=184, reason="gathers the contacts with a mesh in an array"),
    "walls_forces.comp": Limits(vgprs=192, reason=SURFACES),
    "walls_impulses.comp": Limits(vgprs=152, reason=SURFACES),
}

# A scene with every feature that a model may have.
EVERYTHING = {
    "name": "everything",
    "gravity": [0, 0, -9.81],
    "fields": [
        {"drag": {"velocity": [1, 0, 0], "vortex": {"centre": [0, 0, 0], "axis": [0, 0, 1], "speed": 1, "core": 1}},
         "inCylinder": {"from": [0, 0, 0], "to": [0, 0, 1], "radius": 1}},
        {"buoyancy": {"surface": [0, 0, 0.5]}, "inSphere": {"centre": [0, 0, 0], "radius": 1}},
        {"spring": {"centre": [0, 0, 0], "stiffness": 1e-3, "damping": 1e-4}},
        {"attraction": {"centre": [0, 0, 0], "strength": 1, "softening": 1}}],
    "bounds": {"min": [-2, -2, 0], "max": [2, 2, 3], "open": ["Z_MAX"], "material": "b"},
    "materials": [
        {"name": "a", "friction": 0.4, "rollingResistance": 0.1, "spinningResistance": 0.05, "young": 1e9},
        {"name": "b", "friction": 0.7, "rollingResistance": 0.1, "density": 2500, "young": 2e9},
    ],
    "obstacles": [
        {"plane": {"point": [0, 0, 0.01], "normal": [0, 0, 1]}},
        {"box": {"min": [-0.2, -0.2, 0.1], "max": [0.2, 0.2, 0.4]}, "motion": {"spin": [0, 0, 3]}},
        {"sphere": {"centre": [1, 0, 0.3], "radius": 0.2}},
        {"cylinder": {"from": [1, 1, 0.2], "to": [1, 1, 0.6], "radius": 0.1}},
        {"cone": {"from": [-1, 1, 0.2], "to": [-1, 1, 0.6], "fromRadius": 0.2, "toRadius": 0.1}},
        {"cylinder": {"from": [0, 0, 0.01], "to": [0, 0, 2.9], "radius": 1.8, "hollow": True}},
        {"disc": {"centre": [1, -1, 0.4], "normal": [0, 0, 1], "radius": 0.2}},
        {"capsule": {"from": [-1, -1, 0.2], "to": [-1, -1, 0.6], "radius": 0.1}},
        {"heightField": {"heights": [0.1, 0.2, 0.2, 0.1], "columns": 2, "min": [0.3, 0.6, 0.1],
                         "max": [0.8, 0.9, 0.2]}},
        {"box": {"min": [-0.2, -1.4, 0.5], "max": [0.2, -1.2, 0.6]},
         "motion": {"drive": {"along": [0, 0, 1], "mass": 3, "force": -20, "mostSpeed": 3}}},
    ],
    "groups": [
        {"lattice": {"min": [-0.5, -0.5, 1], "max": [0.5, 0.5, 2], "spacing": 0.06, "count": 2000},
         "radius": {"constant": 0.02}},
        {"list": {"spheres": [{"position": [0, 0, 2.5]}]}, "radius": {"constant": 0.2}, "material": "b"},
        {"list": {"spheres": [{"position": [0, 1, 2]}]}, "radius": {"constant": 0.02}, "fixed": True},
    ],
    "sinks": [{"region": {"min": [-9, -9, -9], "max": [9, 9, -8]}}],
    "contactSums": True,
}


def everything(model, shapes=None, periodic=False, movers=False):
    """`shapes`: those that obstacles may have; all by default. `movers`: spheres of similar size only."""
    scene = copy.deepcopy(EVERYTHING)
    if model == "fast":  # has no driven bodies
        scene["obstacles"] = [one for one in scene["obstacles"] if "drive" not in one.get("motion", {})]
    if shapes is not None:
        scene["obstacles"] = [one for one in scene["obstacles"] if shapes & set(one)]
    if periodic:
        scene["bounds"] |= {"periodic": ["X", "Y"]}
        scene["fields"] = [{"drag": {"velocity": [1, 0, 0]}}]  # the others have no images
    if movers:
        scene["groups"] = [one for one in scene["groups"] if one["radius"]["constant"] < 0.1]
    return scene


def flags():
    """The flag of each feature by the name that `spherule plan` prints."""
    rows = (SHADERS / "features.def").read_text(encoding="utf-8") + (SHADERS / "shapes.def").read_text(encoding="utf-8")
    return {text: flag for flag, text in re.findall(r'^(?:FEATURE|SHAPE)\((\w+), \w+, "?([^",]+)"?[,)]', rows, re.M)}


@dataclasses.dataclass
class FeatureSet:
    title: str
    features: dict  # flag: bool
    launched: set  # the kernels that the plan lists


def plan(title, scene, model):
    """The features of a scene, a dict or a path; None if the scene of the path is none for the model, if given."""
    with tempfile.TemporaryDirectory() as folder:
        path = scene
        if isinstance(scene, dict):
            path = Path(folder) / "scene.json"
            path.write_text(json.dumps(scene), encoding="utf-8")
        command = [SPHERULE, "plan", str(path), "--json", *(["--quality", model] if model else [])]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    if done.returncode == 2 and model and not isinstance(scene, dict):
        return None
    if done.returncode != 0:
        raise AssertionError(f"{title}: {done.stderr}")
    result = json.loads(done.stdout)
    named = flags()
    return FeatureSet(title, {named[text]: on for text, on in result["features"].items()},
                      {row["kernel"] for row in result["passes"]})


def feature_sets(form):
    if form == "largest":
        return [plan(f"meshes, {model}", everything(model, {"plane", "box", "heightField"}, movers=movers), model)
                for movers in (False, True) for model in MODELS]
    sets = [plan(f"everything, {model}", everything(model), model) for model in MODELS]
    sets += [plan(f"periodic, {model}", everything(model, {"plane"}, periodic=True), model) for model in MODELS]
    sets += [plan(f"movers, {model}", everything(model, movers=True), model) for model in MODELS]
    for path in sorted(SCENES.glob("*.json")):
        own = plan(path.stem, path, None)
        sets += [own] + [one for model in MODELS if (one := plan(f"{path.stem}, {model}", path, model))]
    return sets


def variants(sets, once):
    """Each kernel with the sets in which it is launched, or with all sets if plans do not list it: (kernel, set,
    lines). Sets that differ only in features that the kernel does not test count as one. `once`: only the first set
    of each."""
    planned = set().union(*(one.launched for one in sets))
    for kernel in kernels.names(SHADERS):
        lines = list(kernels.declared(kernels.expand(SHADERS, kernel)))
        seen = set()
        for one in sets:
            tested = tuple(one.features[name] for name in kernels.features_in(lines))
            if tested in seen or (kernel in planned and kernel not in one.launched):
                continue
            seen.add(tested)
            yield kernel, one, [line for _, line in lines]
            if once:
                break


def for_vulkan(features, lines):
    """The kernel as Vulkan has it. Without `precise`, which forbids contraction and takes glslang minutes."""
    text = "\n".join(kernels.prologue(features) + lines) + "\n"
    uniform = "layout(location = 0) uniform uint phase;"
    assert text.count(uniform) == 1, f"shared/kernel.h no longer has the line {uniform}"
    text = text.replace(uniform, "layout(push_constant) uniform PhaseBlock { uint phase; };")
    return re.sub(r"\bprecise ", "", text)


def to_spirv(title, text, path):
    """Writes `path`, and returns the compiler's messages; empty if it and the validator accept the text."""
    source = path.with_suffix(".comp")
    source.write_text(text, encoding="utf-8")
    environment = ["--target-env", "vulkan1.1"]
    compiler = [GLSLANG, "-V", *environment, "--shift-UBO-binding", str(UNIFORMS_AT), "--auto-map-bindings", "-o",
                str(path), str(source)]
    # Removing dead code takes the driver longer.
    optimizer = ["spirv-opt", "--target-env=vulkan1.1", "--eliminate-dead-branches", "--ssa-rewrite",
                 "--eliminate-dead-branches", "--eliminate-dead-functions", str(path), "-o", str(path)]
    for command in (compiler, ["spirv-val", *environment, str(path)], optimizer):
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
        except subprocess.TimeoutExpired:
            return [f"{title}: {Path(command[0]).name} takes longer than 120 s"]
        if done.returncode != 0:
            return [f"{title}: {done.stdout}{done.stderr}"]
    return []


@dataclasses.dataclass
class Figures:
    kernel: str
    title: str  # of the set of features
    vgprs: int
    vgpr_spills: int
    sgpr_spills: int
    scratch: int
    shared: int
    code: int
    seconds: float


def statistics(compiled):
    """The figures of a dict from SPIR-V files to (kernel, title)."""
    icd = glob.glob("/usr/share/vulkan/icd.d/radeon_icd.*.json")
    assert icd, "no /usr/share/vulkan/icd.d/radeon_icd.*.json; install mesa-vulkan-drivers"
    variables = {"RADV_FORCE_FAMILY": "navi21", "VK_ICD_FILENAMES": icd[0], "MESA_SHADER_CACHE_DISABLE": "true"}
    done = subprocess.run([STATISTICS, *map(str, compiled)], capture_output=True, text=True, check=False,
                          env=os.environ | variables)
    assert done.returncode == 0, done.stderr
    for line in done.stdout.splitlines():
        row = json.loads(line)
        assert "NAVI21" in row["renderer"], row["renderer"]
        of = row["statistics"]
        yield Figures(*compiled[Path(row["file"])], of["VGPRs"], of["Spilled VGPRs"], of["Spilled SGPRs"],
                      of["Scratch size"] // 64, of["LDS size"], of["Code size"], row["seconds"])


def excesses(figures, limits):
    """Messages about figures above the limits."""
    for name, value, limit in (
            ("registers per lane", figures.vgprs, limits.vgprs), ("spilled registers", figures.vgpr_spills, 0),
            ("spilled scalar registers", figures.sgpr_spills, limits.sgpr_spills),
            ("bytes of scratch memory", figures.scratch, limits.scratch),
            ("bytes of code", figures.code, limits.code)):
        if value > limit:
            yield f"{figures.kernel} ({figures.title}): {value:,} {name}, limit {limit:,}"


def compile_all(texts):
    """`texts`: (kernel, title, text). Returns figures and messages."""
    with tempfile.TemporaryDirectory() as folder:
        compiled, messages = {}, []
        for kernel, title, text in texts:
            path = Path(folder) / f"{len(compiled)}.spv"
            refused = to_spirv(f"{kernel} ({title})", text, path)
            messages += refused
            if not refused:
                compiled[path] = (kernel, title)
        return list(statistics(compiled)), messages


def table(all_figures):
    lines = [f"{'kernel':28} VGPRs  spills  scratch   LDS     code  compiled in  variants"]
    for kernel in sorted({one.kernel for one in all_figures}):
        own = [one for one in all_figures if one.kernel == kernel]
        most = {name: max(getattr(one, name) for one in own)
                for name in ("vgprs", "scratch", "shared", "code", "seconds")}
        spills = max(one.vgpr_spills + one.sgpr_spills for one in own)
        lines.append(f"{kernel:28} {most['vgprs']:5} {spills:7} {most['scratch']:8} {most['shared']:5} {most['code']:8}"
                     f" {most['seconds']:10.2f} s {len(own):9}")
    return "\n".join(lines)


class Registers(unittest.TestCase):
    def test_no_kernel_exceeds_its_limits(self):
        sets = feature_sets(FORM)
        figures, messages = compile_all((kernel, one.title, for_vulkan(one.features, lines))
                                        for kernel, one, lines in variants(sets, FORM == "largest"))
        print(table(figures))
        self.assertEqual({one.kernel for one in figures}, set(kernels.names(SHADERS)))
        for one in figures:
            messages += excesses(one, LIMITS.get(one.kernel, Limits()))
        self.assertEqual(messages, [], "\n" + "\n".join(messages))

    def test_limits_are_those_of_kernels(self):
        self.assertEqual([name for name in LIMITS if name not in kernels.names(SHADERS)], [])
        self.assertEqual([name for name, one in LIMITS.items() if not one.reason], [])

    def test_the_scenes_with_everything_have_every_feature(self):
        sets = [plan(model, everything(model), model) for model in MODELS]
        sets.append(plan("periodic", everything("fast", {"plane"}, periodic=True), "fast"))
        sets.append(plan("movers", everything("balanced", movers=True), "balanced"))
        missing = [flag for flag in flags().values() if not any(one.features[flag] for one in sets)]
        self.assertEqual(missing, [], "add them to EVERYTHING")

    def planted(self, body):
        """The messages about a kernel of this body, whose buffer is `a`."""
        text = f"""#version 450 core
            layout(local_size_x = 64) in;
            layout(std430, binding = 0) restrict buffer aBlock {{ float a[]; }};
            void main() {{ uint k = gl_GlobalInvocationID.x; {body} }}"""
        figures, messages = compile_all([("planted.comp", "no feature", text)])
        return messages + [message for one in figures for message in excesses(one, Limits())]

    def test_a_planted_kernel_with_many_values_is_reported(self):
        def body(values):
            read = "".join(f"float v{n} = a[k + {n}u * 64u];" for n in range(values))
            written = "".join(f"a[k * 64u + {n}u] = v{n} * v{values - 1 - n};" for n in range(values))
            return read + "memoryBarrierBuffer(); barrier();" + written
        self.assertEqual(self.planted(body(64)), [])
        found = "\n".join(self.planted(body(200)))
        self.assertRegex(found, r"planted.comp \(no feature\): \d+ registers per lane, limit 128")
        self.assertNotIn("spilled", found)
        found = "\n".join(self.planted(body(600)))
        self.assertRegex(found, r"planted.comp \(no feature\): \d+ spilled registers, limit 0")

    def test_a_planted_kernel_with_an_array_is_reported(self):
        found = self.planted("float v[256]; for (uint n = 0u; n < 256u; ++n) v[n] = a[k + n];"
                             "a[k] = v[floatBitsToUint(a[k]) % 256u];")
        self.assertEqual(found, ["planted.comp (no feature): 1,024 bytes of scratch memory, limit 0"])

    def test_a_planted_kernel_that_is_no_glsl_is_reported(self):
        found = "\n".join(self.planted("a[k] = nothing;"))
        self.assertIn("planted.comp (no feature): ", found)
        self.assertIn("'nothing' : undeclared identifier", found)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
