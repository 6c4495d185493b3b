#!/usr/bin/env python3
"""What only a terminal, a shell or man sees of the command: the bar, colours, interrupts, closed pipes, completions
and the manual page.

    tests/command_in_terminal.py --command build/release/bin/scan2fea --scan examples/bracket.ply
"""
import argparse
import fcntl
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

failures = []


def require(condition, text):
    if not condition:
        failures.append(text)
        print("FAILED:", text)


def set_size(descriptor, columns):
    fcntl.ioctl(descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))


def in_terminal(arguments, columns=80, environment=None, interrupt_when=None, of_stdout=False):
    """Runs with stderr (and stdout, if asked for) on a terminal; returns the exit status and what it showed."""
    master, slave = pty.openpty()
    set_size(slave, columns)
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=slave if of_stdout else out,
                                   stderr=slave, env={**os.environ, "TERM": "xterm", **(environment or {})})
        os.close(slave)
        shown = b""
        interrupted = False
        while True:
            if select.select([master], [], [], 0.05)[0]:
                try:
                    piece = os.read(master, 65536)
                except OSError:
                    break
                if not piece:
                    break
                shown += piece
            if interrupt_when and not interrupted and interrupt_when in shown:
                interrupted = True
                process.send_signal(signal.SIGINT)
        os.close(master)
        return process.wait(), shown.decode()


def screen(shown, columns):
    """The lines that a terminal is left with: carriage returns, and erasing to the end of a line."""
    lines, line, at = [], [], 0
    for part in re.findall(r"\x1b\[[0-9;]*[A-Za-z]|.|\n", shown, re.DOTALL):
        if part == "\n":
            lines.append("".join(line))
            line, at = [], 0
        elif part == "\r":
            at = 0
        elif part == "\x1b[K":
            del line[at:]
        elif part.startswith("\x1b"):
            require(part.endswith("m"), f"an escape sequence that is no colour: {part!r}")
        else:
            line[at:at + 1] = [part]
            at += 1
    lines.append("".join(line))
    return lines


def bars(shown):
    return [piece for piece in re.findall(r"\r\x1b\[K([^\r\n\x1b]*)", shown) if "%" in piece]


def check_bar(command, scan, folder):
    run = [command, "run", scan, "-o", f"{folder}/bar.inp", "--force"]
    for columns in (20, 40, 80, 200):
        status, shown = in_terminal(run + ["--effort", "low"], columns)
        require(status == 0, f"exit status {status} on {columns} columns")
        drawn = bars(shown)
        require(len(drawn) > 5, f"{len(drawn)} bars on {columns} columns")
        require(all(len(bar) < columns for bar in drawn), f"a bar as wide as {columns} columns wraps")
        percent = [int(re.search(r"(\d+) %", bar).group(1)) for bar in drawn]
        require(percent == sorted(percent), f"the bar goes back: {percent}")
        require(screen(shown, columns)[-1] == "", "the bar is left on the terminal")
        require(not any("%" in line and "[" in line for line in screen(shown, columns)), "a bar stays among the lines")
        if columns >= 80:
            require(any("laying triangles" in bar for bar in drawn), "the stage is not in plain words")
            require(any("left" in bar for bar in drawn), "the time left is not told")
    for quiet in (["--quiet"], ["--progress", "off"]):
        status, shown = in_terminal(run + quiet)
        require(status == 0 and not bars(shown), f"a bar in spite of {quiet}")
    require(not bars(in_terminal(run, environment={"TERM": "dumb"})[1]), "a bar on a dumb terminal")


def check_colours(command, folder):
    wrong = [command, "check", f"{folder}/absent.ply"]
    require("\x1b[1;31m" in in_terminal(wrong)[1], "errors are not coloured on a terminal")
    require("\x1b[1;31m" not in in_terminal(wrong, environment={"NO_COLOR": "1"})[1], "NO_COLOR is not respected")
    piped = subprocess.run(wrong, stderr=subprocess.PIPE, check=False)
    require(b"\x1b" not in piped.stderr, "colours go into a pipe")


def check_interrupts(command, scan, folder):
    for word in (b"reading", b"laying", b"filling"):  # repair may end before the bar is drawn again
        status, shown = in_terminal([command, "run", scan, "-o", f"{folder}/cut.inp", "--effort", "high"],
                                    interrupt_when=word)
        lines = screen(shown, 80)
        require(status == 130, f"exit status {status} after an interrupt while {word}")
        require(lines[-1] == "" and lines[-2].endswith("interrupted"), f"the terminal is left with {lines[-2:]}")
        require(not any("%" in line and "[" in line for line in lines), "a bar stays after an interrupt")
    require(not any(pathlib.Path(folder).glob("cut*")), "something is left after interrupts")


def check_closed_pipes(command, scan, folder):
    for line in (f"{command} --help", f"{command} run --help", f"{command} manual", f"{command} completion bash",
                 f"{command} check {scan}", f"{command} check {scan} --json -",
                 f"{command} surface {scan} -o {folder}/head.ply --force",
                 f"{command} surface {scan} -o - --to obj --faces 4000 --quiet",
                 f"{command} surface {scan} -o {folder}/head.ply --force --progress json 2>&1"):
        done = subprocess.run(["bash", "-c", f"{line} | head -1; exit ${{PIPESTATUS[0]}}"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, check=False)
        require(done.returncode == 0, f"{line} | head -1 exits with {done.returncode}")
        told = [text for text in done.stderr.decode().splitlines() if "stdout" in text or "pipe" in text.lower()]
        require(not told, f"{line} | head -1 says {told}")
    require(os.path.exists(f"{folder}/head.ply"), "the mesh is not written where nobody reads the figures")


def completed(script, words):
    """What bash offers for the last of these words."""
    line = ("source " + script + "; COMP_WORDS=(" + " ".join(f"'{word}'" for word in words) +
            f"); COMP_CWORD={len(words) - 1}; _scan2fea; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    done = subprocess.run(["bash", "--norc", "-c", line], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True,
                          cwd=os.path.dirname(script))
    require(done.stderr == b"", f"completing {words} says {done.stderr.decode()}")
    return set(done.stdout.decode().split())


def check_completions(command, folder):
    script = f"{folder}/completion.bash"
    pathlib.Path(script).write_bytes(subprocess.run([command, "completion", "bash"], stdout=subprocess.PIPE,
                                                    check=True).stdout)
    pathlib.Path(f"{folder}/part of mine.stl").touch()
    os.makedirs(f"{folder}/partfolder", exist_ok=True)
    for words, wanted, unwanted in (
            (["scan2fea", ""], {"run", "check", "convert", "--help"}, {"--faces"}),
            (["scan2fea", "re"], {"repair", "reconstruct"}, {"run"}),
            (["scan2fea", "run", "--fa"], {"--faces"}, {"--force"}),
            (["scan2fea", "run", "x.stl", "--effort", ""], {"low", "normal", "high"}, {"x.stl"}),
            (["scan2fea", "run", "--effort", "h"], {"high"}, {"low"}),
            (["scan2fea", "run", "--effort", "="], {"low", "normal", "high"}, set()),
            (["scan2fea", "run", "--effort", "=", "n"], {"normal"}, {"low"}),
            (["scan2fea", "run", "--feature-angle", ""], {"off"}, set()),
            (["scan2fea", "surface", "--or"], set(), {"--order"}),
            (["scan2fea", "run", "-o", "part"], {"part", "of", "mine.stl"}, {"low"}),
            (["scan2fea", "run", "--report", "part"], {"partfolder"}, {"mine.stl"}),
            (["scan2fea", "run", "part"], {"mine.stl", "partfolder"}, set()),
            (["scan2fea", "run", "--faces", ""], set(), {"completion.bash"}),
            (["scan2fea", "completion", ""], {"bash", "zsh", "fish"}, set())):
        offered = completed(script, words)
        require(wanted <= offered, f"{words} is completed by {sorted(offered)}, not {sorted(wanted)}")
        require(not unwanted & offered, f"{words} is completed by {sorted(unwanted & offered)}")
    for shell in ("zsh", "fish"):
        text = subprocess.run([command, "completion", shell], stdout=subprocess.PIPE, check=True).stdout.decode()
        require("tetrahedralize" in text and "low normal high" in text, f"{shell} gets no words to complete")
        if shutil.which(shell):
            read = subprocess.run([shell, "-n"], input=text, text=True, stderr=subprocess.PIPE, check=False)
            require(read.returncode == 0, f"{shell} cannot read its completion: {read.stderr}")


def check_interactive_completion(command, folder):
    """In a shell that a person types into."""
    master, slave = pty.openpty()
    set_size(slave, 120)
    environment = {**os.environ, "TERM": "dumb", "PS1": "$ ", "PATH": f"{os.path.dirname(command)}:{os.environ['PATH']}"}
    shell = subprocess.Popen(["bash", "--norc", "-i"], stdin=slave, stdout=slave, stderr=slave, env=environment,
                             cwd=folder, start_new_session=True)
    os.close(slave)

    def typed(text, seconds=2.0):
        os.write(master, text.encode())
        shown, end = b"", time.monotonic() + seconds
        while time.monotonic() < end:
            if select.select([master], [], [], 0.05)[0]:
                shown += os.read(master, 65536)
        return shown.decode()

    typed("bind 'set enable-bracketed-paste off'; source completion.bash\n")
    require("scan2fea tetrahedralize " in typed("scan2fea tetra\t"), "TAB does not complete a command")
    require("--interior-size " in typed("x.stl --int\t"), "TAB does not complete an option")
    shell.kill()
    shell.wait()
    os.close(master)


def check_manual(command, folder):
    page = f"{folder}/scan2fea.1"
    pathlib.Path(page).write_bytes(subprocess.run([command, "manual"], stdout=subprocess.PIPE, check=True).stdout)
    if shutil.which("man"):
        read = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", page], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"},
                              check=False)
        require(read.returncode == 0 and read.stderr == b"", f"man says {read.stderr.decode()}")
        text = re.sub(r".\x08", "", read.stdout.decode())
        text = re.sub(r"\x1b\[[0-9;]*m", "", text)
        for words in ("--faces N", "EXIT STATUS", "scan2fea run scan.ply -o part.inp", "NO_COLOR"):
            require(words in text, f"the manual page has no {words!r}")
    if shutil.which("mandoc"):
        read = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], stdout=subprocess.PIPE, check=False)
        require(read.returncode == 0, f"mandoc says {read.stdout.decode()}")
    # Each option that the help names is in the page.
    manual = pathlib.Path(page).read_text().replace("\\-", "-")
    for name in ("run", "check", "convert", "faces", "compare"):
        told = subprocess.run([command, name, "--help"], stdout=subprocess.PIPE, check=True).stdout.decode()
        for option in re.findall(r"^  (?:-\w, )?(--[a-z-]+)", told, re.MULTILINE):
            require(f"\\fB{option}\\fR" in manual, f"the manual page has no {option} of {name}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", required=True)
    parser.add_argument("--scan", required=True)
    options = parser.parse_args()
    command, scan = os.path.abspath(options.command), os.path.abspath(options.scan)
    with tempfile.TemporaryDirectory() as folder:
        check_completions(command, folder)
        check_interactive_completion(command, folder)
        check_manual(command, folder)
        check_colours(command, folder)
        check_bar(command, scan, folder)
        check_interrupts(command, scan, folder)
        check_closed_pipes(command, scan, folder)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
