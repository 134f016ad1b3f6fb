"""How many mutants of `src/plan` its tests kill, as Markdown; `benches/mutants.sh` says how to ask.

All mutants that `cargo mutants` lists are compiled into one copy of the tree: the body of each
function becomes a choice among its mutants, by the environment variable MUTANT; so does the closure
of a rule. What a constant or a `const fn` says is fixed when it is compiled: those mutants are
built one by one, by themselves in a file that names no other. A mutant that does not compile is not
counted. A test that fails ends its process: no other has to run."""

import json
import os
import random
import re
import resource
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

CHOICES, ALONE = Path("target/mutants/choices"), Path("target/mutants/alone")
# Unit tests of a file, or those of the plan, then its suite, what takes longest last: (program,
# arguments).
SLOW = ["law::", "validation::", "counters::", "paths::"]
STAGES = [
    ("file", []),
    ("rtc_plan", []),
    ("suites", ["plan::path_"]),
    ("suites", ["plan::", *(f"--skip=plan::{name}" for name in ["path_", *SLOW])]),
    ("suites", [f"plan::{name}" for name in SLOW]),
    ("files", ["plan: "]),
]
CHOICE = """//! Which mutant runs.
/// Its number, or 0.
pub fn chosen() -> u32 {
    static CHOSEN: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    *CHOSEN.get_or_init(|| {
        std::panic::set_hook(Box::new(|_| std::process::exit(101)));
        std::env::var("MUTANT").map_or(0, |number| number.parse().expect("a number"))
    })
}
"""


def offsets(text, span):
    """Where a span of lines and columns starts and ends in a text."""
    lines = text.splitlines(keepends=True)
    return [
        sum(map(len, lines[: end["line"] - 1])) + end["column"] - 1
        for end in (span["start"], span["end"])
    ]


def closure(text, at):
    """Where the closure of a rule around a place starts and ends, if there is one."""
    spans = (
        found.span(1)
        for found in re.finditer(r"^    \w+: (\|\w+\| \{.*?^    \})", text, re.M | re.S)
    )
    return next((span for span in spans if span[0] <= at < span[1]), None)


class Mutant:
    def __init__(self, number, told, text):
        self.number, self.name, self.file = number, told["name"], told["file"]
        self.replacement, self.at = told["replacement"], offsets(text, told["span"])
        self.function = (
            offsets(text, told["function"]["span"])
            if told["function"]
            else closure(text, self.at[0])
        )
        self.is_fixed = not self.function or "const fn " in text[self.function[0] : self.at[0]]
        self.is_viable = True

    def apply(self, text, start, end):
        """The part of a text from `start` to before `end`, with the change."""
        return text[start : self.at[0]] + self.replacement + text[self.at[1] : end]


def listed():
    """All mutants, and the files they are in."""
    told = json.loads(subprocess.check_output(["cargo", "mutants", "--list", "--json"]))
    texts = {mutant["file"]: Path(mutant["file"]).read_text() for mutant in told}
    return [
        Mutant(number, mutant, texts[mutant["file"]]) for number, mutant in enumerate(told, 1)
    ], texts


def functions(mutants):
    """The outermost functions of a file, each with its mutants."""
    spans = sorted(
        {tuple(mutant.function) for mutant in mutants}, key=lambda span: (span[0], -span[1])
    )
    outer = [
        span for k, span in enumerate(spans) if all(span[1] > before[1] for before in spans[:k])
    ]
    for start, end in outer:
        yield start, end, [mutant for mutant in mutants if start <= mutant.at[0] < end]


def chosen_body(text, start, end, mutants):
    """Where the body of a function starts, and the choice among its mutants."""
    fn = re.compile(r"fn \w+[<(][^{]*|\|\w+\| (?=\{)").search(text, start, end)
    iterator = re.search(r"-> impl Iterator<Item = (.*)> $", fn[0])
    before, after = ("(", ").collect::<Vec<_>>()") if iterator else ("", "")
    arms = [
        f"{m.number} => {before}{m.apply(text, fn.end(), end)}{after},\n"
        for m in mutants
        if m.is_viable
    ]
    arms.append(f"_ => {before}{text[fn.end() : end]}{after},\n")
    choice = "match crate::mutant::chosen() {\n" + "".join(arms) + "}"
    if iterator:
        choice = f"let all: Vec<{iterator[1]}> = {choice};\nall.into_iter()"
    return fn.end(), "{\n" + choice + "\n}"


def mutated(text, mutants):
    """A file with the choices among its mutants."""
    done, out = 0, ""
    for start, end, own in functions(mutants):
        body, choice = chosen_body(text, start, end, own)
        out, done = out + text[done:body] + choice, end
    return out + text[done:]


def write(path, text):
    """Writes a file of a copy; one that is as it was keeps its time, so that cargo builds no more
    than it must."""
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def with_choice(file, text):
    """A file of the copy: the root of the plan has a module with the choice, too."""
    return text + ("pub mod mutant;\n" if file == "src/plan/lib.rs" else "")


def copy_tree(tree, texts):
    """Copies the library, but for the texts, and the suites; what else they read is seen through
    links."""
    tracked = subprocess.check_output(["git", "ls-files"], text=True).splitlines()
    tree.mkdir(parents=True, exist_ok=True)
    for name in {file.split("/")[0] for file in tracked} - {"src", "tests", "Cargo.toml"} | {
        "../shared"
    }:
        if not (tree / name).is_symlink():
            (tree / name).symlink_to(Path(name).resolve())
    for file in tracked:
        if file.startswith("src/") and file.endswith(".rs") and file not in texts:
            write(tree / file, with_choice(file, Path(file).read_text()))
        elif file.startswith(("src/", "tests/")) and file not in texts:
            (tree / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, tree / file)
    write(tree / "src/plan/mutant.rs", CHOICE)
    toml = Path("Cargo.toml").read_text()
    lints = ["arithmetic_overflow", "unconditional_panic", "unconditional_recursion"]
    toml = toml.replace(
        "[workspace.lints.rust]\n",
        "[workspace.lints.rust]\n" + "".join(f'{lint} = "allow"\n' for lint in lints),
    )
    write(tree / "Cargo.toml", toml)


def build(tree):
    """The test programs, by name; or the errors, each as the places it names.

    A mutant alone runs once: it is not optimised, which builds it in a third of the time.
    """
    command = [
        "cargo",
        "test",
        "-j1",
        "--no-run",
        "-p",
        "rtc-plan",
        "-p",
        "rtc",
        "--lib",
        "--test",
        "suites",
        "--test",
        "files",
        "--message-format=json",
    ]
    command.append(f"--target-dir={Path('target').resolve()}")
    command.append(f"--config=profile.dev.package.rtc-plan.opt-level={1 if tree == CHOICES else 0}")
    said = subprocess.run(
        command, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    programs, errors = {}, []
    for message in map(json.loads, said.stdout.splitlines()):
        if message.get("executable"):
            programs[message["target"]["name"]] = message["executable"]
        if (
            message.get("message", {}).get("level", "").startswith("error")
            and message["message"]["spans"]
        ):
            errors.append(
                [(span["file_name"], span["line_start"]) for span in message["message"]["spans"]]
            )
    if said.returncode and not errors:
        sys.exit(said.stderr)
    return programs, errors


def owner(path, line):
    """The number of the mutant that a line of a mutated file belongs to."""
    for text in reversed((CHOICES / path).read_text().splitlines()[:line]):
        if found := re.match(r"(\d+|_) => ", text):
            return 0 if found[1] == "_" else int(found[1])
    return 0


def build_all(mutants, texts):
    """Builds all mutants that compile."""
    by_number = {mutant.number: mutant for mutant in mutants}
    while True:
        for file, text in texts.items():
            own = [mutant for mutant in mutants if mutant.file == file]
            write(CHOICES / file, with_choice(file, mutated(text, own)))
        programs, errors = build(CHOICES)
        if not errors:
            return programs
        numbers = {next(filter(None, (owner(*place) for place in places)), 0) for places in errors}
        if numbers == {0}:
            sys.exit(f"the copy does not compile: {errors}")
        print(f"{len(numbers)} do not compile", file=sys.stderr)
        for number in numbers - {0}:
            by_number[number].is_viable = False


def build_one(mutant, texts):
    """Builds a mutant alone; the test programs."""
    if not re.search(r"crate::|super::(?!\*)", re.sub(r"//.*", "", texts[mutant.file])):
        return build_file(mutant, texts[mutant.file])
    for file, text in texts.items():
        write(
            ALONE / file,
            with_choice(file, mutant.apply(text, 0, len(text)) if file == mutant.file else text),
        )
    programs, errors = build(ALONE)
    mutant.is_viable = not errors
    return programs


def build_file(mutant, text):
    """Builds the unit tests of a file that names no other."""
    source, program = ALONE / "file.rs", ALONE.resolve() / "file"
    write(source, mutant.apply(text, 0, len(text)))
    command = ["rustc", "--edition=2024", "--test", "--cap-lints=allow", "-o", program, source]
    mutant.is_viable = subprocess.run(command, stderr=subprocess.DEVNULL).returncode == 0
    return {"file": program}


def run(program, arguments, number, seconds):
    """Runs tests of a mutant: whether they fail, and the CPU time."""

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

    environment = os.environ | {"MUTANT": str(number), "PROPTEST_RNG_SEED": "1"}
    child = subprocess.Popen(
        [program, "--test-threads=1", *arguments],
        cwd="target/mutants",
        env=environment,
        preexec_fn=limit,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, used = os.wait4(child.pid, 0)
    return status, used.ru_utime + used.ru_stime


def stages(programs):
    return [(programs[name], arguments) for name, arguments in STAGES if name in programs]


def fate(programs, number, limits):
    for (program, arguments), seconds in zip(stages(programs), limits):
        status, _ = run(program, arguments, number, seconds)
        if status:
            is_late = os.WIFSIGNALED(status) and os.WTERMSIG(status) in (9, 24)
            return "timeout" if is_late else "killed"
    return "survived"


def judged(mutant, programs, number, limits):
    """A mutant and its fate, which is told at once."""
    end = fate(programs, number, limits)
    print(end, mutant.name, file=sys.stderr, flush=True)
    return mutant, end


def limits_of(programs):
    """Twenty times what each stage takes where nothing is changed, and some seconds."""
    sound = [run(program, arguments, 0, 600) for program, arguments in stages(programs)]
    if any(status for status, _ in sound):
        sys.exit("nothing is changed, and a test fails")
    return [int(20 * used) + 8 for _, used in sound]


def report(fates, unviable, command):
    kinds = ["killed", "timeout", "survived"]
    counts = lambda of: [sum(fate == kind for _, fate in of) for kind in kinds]
    killed, late, survived = counts(fates)
    print(
        "# Mutants of the plan\n\n"
        "A mutant is a copy of the plan with one small change. The tests should detect each.\n\n"
        f"`{command}`\nwrote this page: {killed + late} of {len(fates)} mutants are detected, "
        f"{100 * (killed + late) / max(len(fates), 1):.1f} %. {unviable} more do not compile.\n\n"
        f"{os.environ['STATE']}\n"
    )
    print("| file | killed | by timeout | survive |\n| --- | --: | --: | --: |")
    for file in sorted({mutant.file for mutant, _ in fates}):
        own = counts([(mutant, fate) for mutant, fate in fates if mutant.file == file])
        print(f"| {file} | {' | '.join(map(str, own))} |")
    if survived:
        print(
            "\nSurvivors:\n\n"
            + "\n".join(f"- `{mutant.name}`" for mutant, fate in fates if fate == "survived")
        )


def main(count, seed, pattern):
    os.nice(10)
    mutants, texts = listed()
    picked = [mutant for mutant in mutants if re.search(pattern, mutant.name)]
    if count < len(picked):
        picked = random.Random(seed).sample(picked, count)
    copy_tree(CHOICES, texts)
    copy_tree(ALONE, texts)
    programs = build_all([mutant for mutant in picked if not mutant.is_fixed], texts)
    limits = limits_of(programs)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        chosen = [mutant for mutant in picked if mutant.is_viable and not mutant.is_fixed]
        fates = list(
            pool.map(lambda mutant: judged(mutant, programs, mutant.number, limits), chosen)
        )
    for mutant in picked:
        alone = build_one(mutant, texts) if mutant.is_fixed else {}
        if mutant.is_fixed and mutant.is_viable:
            fates.append(judged(mutant, alone, 0, limits))
    command = "benches/mutants.sh" + (
        f" {count} {seed} '{pattern}'" if len(picked) < len(mutants) else ""
    )
    report(fates, sum(not mutant.is_viable for mutant in picked), command)


main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
