import signal
import socket
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from app.server import serve
from tests.app.synthetic import source

SCRIPT = """
from app.server import serve
from tests.app.synthetic import SETTINGS, source

serve(source(3), port=0, settings=SETTINGS)
"""


def test_a_port_in_use_is_named_before_anything_starts() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(ValueError, match=f"Port {port} of 127.0.0.1 is in use; stop the"):
            serve(source(3), port=port)


@pytest.mark.parametrize("port", [-1, 65536])
def test_impossible_ports_are_refused(port: int) -> None:
    with pytest.raises(ValueError, match=f"Port {port} of 127.0.0.1 cannot be used"):
        serve(source(3), port=port)


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.7", "example.org", "::"])
def test_only_this_machine_can_be_listened_on(host: str) -> None:
    with pytest.raises(ValueError, match="listens on this machine only"):
        serve(source(3), host=host)


@pytest.mark.parametrize("signal_number", [signal.SIGINT, signal.SIGTERM])
def test_it_prints_its_address_and_ends_cleanly(signal_number: signal.Signals) -> None:
    folder = Path(__file__).parents[2]
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    line = process.stdout.readline()
    assert line.startswith("radarhull is ready at http://127.0.0.1:")
    address = line.split()[-1]
    assert "<title>radarhull</title>" in httpx.get(address, trust_env=False).text
    process.send_signal(signal_number)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (0, "", "")
    port = int(address.rstrip("/").rsplit(":", 1)[1])
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", port))
