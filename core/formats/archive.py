"""ZIP archives in memory: written whole, and read though nobody vouches for them."""

import io
import zipfile
import zlib
from collections.abc import Iterable, Iterator

MOST_MEMBERS = 20_000
MOST_UNPACKED_BYTES = 512 * 2**20


def packed(members: Iterable[tuple[str, bytes]]) -> bytes:
    """Return named contents as a ZIP archive."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file:
        for name, content in members:
            file.writestr(name, content)
    return archive.getvalue()


def unpacked(content: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield the names and contents of an archive's files, hidden ones left out; all in memory.

    Raises:
        ValueError: no ZIP archive, a damaged or encrypted one, or one that holds too much.
    """
    left_bytes = MOST_UNPACKED_BYTES
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = [member for member in archive.infolist() if not _is_hidden(member)]
            if len(members) > MOST_MEMBERS:
                raise ValueError(
                    f"The archive holds {len(members)} files; at most {MOST_MEMBERS} are taken."
                )
            for member in members:
                # What a member says of its size is not believed.
                with archive.open(member) as file:
                    unpacked_bytes = file.read(left_bytes + 1)
                left_bytes -= len(unpacked_bytes)
                if left_bytes < 0:
                    raise ValueError(
                        f"The archive unpacks to more than {MOST_UNPACKED_BYTES // 2**20} MiB."
                    )
                yield member.filename, unpacked_bytes
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        raise ValueError(f"The archive cannot be read: {error}.") from error
    except zlib.error as error:
        raise ValueError(f"The archive is damaged: {error}.") from error


def _is_hidden(member: zipfile.ZipInfo) -> bool:
    name = member.filename.rpartition("/")[2]
    return member.is_dir() or name.startswith(".") or member.filename.startswith("__MACOSX/")
