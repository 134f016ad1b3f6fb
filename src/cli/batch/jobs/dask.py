"""@TITLE@.

python run.py [SCHEDULER]: on the workers of a scheduler, as tcp://host:8786, or on two of its own."""
import os
import subprocess
import sys

from dask.distributed import Client

FOLDER = os.path.dirname(os.path.abspath(__file__))
RTC = os.environ.get("RTC", "rtc")
PART = @PART@
MERGE = @MERGE@
PARTS = @PARTS@
FRAMES = @FRAMES@
RETRIES = @RETRIES@


def run(words, *after):
    """Runs one command of rtc, after others. What it writes is whole: if it is there, it is done."""
    if not os.path.exists(os.path.join(FOLDER, words[-1])):
        subprocess.run([RTC, *words], cwd=FOLDER, check=True)


def filled(words, frame, part=0):
    return [word.replace("{frame}", frame).replace("{part}", str(part)) for word in words]


if __name__ == "__main__":
    scheduler = sys.argv[1:2] or [None]
    workers = {} if sys.argv[1:2] else {"n_workers": 2, "threads_per_worker": 1}
    with Client(*scheduler, **workers) as client:
        pictures = []
        for frame in FRAMES:
            words = [filled(PART, frame, part) for part in range(1, PARTS + 1)]
            parts = [client.submit(run, word, retries=RETRIES, pure=False) for word in words]
            merge = filled(MERGE, frame)
            pictures.append(client.submit(run, merge, *parts, retries=RETRIES, pure=False))
        client.gather(pictures)
