"""What benches share that ask real clients: commands that stop the run where they fail, and the folder with the clients' packages."""
import filecmp
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*command, **options):
    """What it printed on stdout; both outputs where it fails."""
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command[:3]))} …: exit {done.returncode}\n{(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def prepare_clients():
    """The folder with the clients' packages and pages, those of the benches among them; as tests/clients/run makes it."""
    work = ROOT / "build/clients"
    shutil.copytree(ROOT / "tests/clients", work, dirs_exist_ok=True)
    shutil.copytree(ROOT / "bench/streaming_clients", work, dirs_exist_ok=True)
    lock, installed = work / "package-lock.json", work / "node_modules/.colod-lock"
    if not installed.exists() or not filecmp.cmp(lock, installed, shallow=False):
        run("npm", "ci", "--ignore-scripts", "--legacy-peer-deps", "--no-audit", "--no-fund", "--loglevel=error", cwd=work)
        shutil.copy(lock, installed)
    return work
