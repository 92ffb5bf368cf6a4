#!/usr/bin/env python3
"""usage: kernels_are_vector_code.py OBJECT [WHY_NOT]: do the AVX2 kernels' loops run on whole registers?

OBJECT: the kernels' library, or focus_kernels_avx2.cpp's object. Looks at its instructions, not at its source: a
conditional too many, or an option that was lost, and g++ makes a scalar loop, which gives the same results at a fraction
of the speed. Instructions are told apart by the function they come from, inlined or not, so the object needs debug
information. WHY_NOT: what about the build makes the question idle, e.g. another compiler. Exit: 0 all loops are vector code, 1 some are not (named), 77 cannot be told here (says why)."""

import collections
import re
import shutil
import subprocess
import sys

NAMESPACE = "fvd::kernels_avx2::"

# Kernel, function whose loop is looked at, the work it does on registers of 32 bytes, and in how many instances of the
# function at least. Only work that nothing but the loop's vector code would do.
LOOPS = [
    ("laplacian_u16", "laplacian_u16", "vpabsd", 1),
    ("tenengrad_u8", "tenengrad", "vpaddd|vpmulld|vpmaddwd", 1),
    ("tenengrad_u16", "tenengrad", "vpmulld", 1),
    ("enter_laplacian_u8", "_mm256_abs_epi16", "vpabsw", 1),
    ("slide_u32", "slide_u32", "vpaddd", 1),
    ("window_sums_u16", "add_rows", "vpaddw", 10),  # of 2 .. 11 rows; of one it is a copy
    ("window_sums_u32", "add_rows", "vpaddd", 10),
    ("root_code", "sqrt", "vsqrtps", 1),
    ("root_code", "root_code", "vcvttps2dq", 1),
    ("maximum_u8", "maximum", "vpmaxub", 1),
    ("maximum_u16", "maximum", "vpmaxuw", 1),
    ("add_to_bin", "add_to_bin", "vpaddw", 1),
    ("widen_u8", "widen_u8", "vpmovzxbw", 1),
    ("update_u8", "update_at", "vpmaxuw", 1),
    ("update_u16", "update_at", "vpmaxuw", 1),
    ("noise_u8", "_mm256_abs_epi16", "vpabsw", 1),
    ("noise_u16", "noise", "vpabsd", 1),
    ("fit_five", "decode", "vcvtdq2ps", 2),  # codes and their roots
    ("fit_five", "find_shares", "vdivps", 1),
    ("fit_five", "add_sample", "vmulps", 1),
    ("fit_five", "sqrt", "vsqrtps", 1),
    ("fit_five", "solve", "vdivps", 1),
    ("fit_five", "judge", "vdivps", 1),
    ("fit_five", "gain", "vmulps", 1),
    ("fit_five", "find_heights", "vmulps", 1),
    ("raise_amplitudes", "raise_amplitudes", "vpmaxud", 1),
    ("finish_sigma", "finish_sigma", "vcmp[a-z_]*ps", 1),
    ("finish_sigma", "sqrt", "vsqrtps", 1),
]


def cannot_tell(why):
    print(f"skipped: {why}")
    sys.exit(77)


def wide_work(listing):
    """{kernel: {function an instruction comes from: mnemonics with operands of 32 bytes}} of `objdump -dlC`."""
    work = {}
    functions = kernel = None
    for line in listing:
        if symbol := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            name = symbol[1]
            inside = name.startswith(NAMESPACE)
            kernel = re.match(r"\w+", name[len(NAMESPACE):])[0] if inside else None
            functions = work.setdefault(kernel, collections.defaultdict(set)) if inside else None
            function = None
        elif functions is None:
            continue
        elif source := re.match(r"(\S.*\)(?: const)?):$", line):
            function = source[1]
        elif (instruction := re.match(r" +[0-9a-f]+:\t(\S+)\s+(.*)", line)) and "%ymm" in instruction[2]:
            functions[function].add(instruction[1])
    return work


def main():
    if len(sys.argv) > 2:
        cannot_tell(sys.argv[2])
    if shutil.which("objdump") is None:
        cannot_tell("objdump is not installed")
    listing = subprocess.run(["objdump", "-dlC", "--no-show-raw-insn", sys.argv[1]], check=True, text=True,
                             stdout=subprocess.PIPE).stdout.splitlines()
    if not any(re.match(r"/.*kernel_\w+-inl\.hpp:\d+", line) for line in listing):
        cannot_tell("the object has no debug information")
    work = wide_work(listing)
    missing = []
    for kernel, part, mnemonics, least in LOOPS:
        part_name = re.compile(rf"(?:^|[ :]){part}(?:<.*>)?\(")
        found = sum(1 for function, used in work.get(kernel, {}).items()
                    if function and part_name.search(function) and any(re.fullmatch(mnemonics, m) for m in used))
        if found < least:
            missing.append(f"{kernel}: {mnemonics} on ymm registers in {found} of {least} instances of {part}()")
    for line in missing:
        print(f"no longer vector code: {line}")
    print(f"{len(LOOPS) - len(missing)} of {len(LOOPS)} loops are vector code")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
