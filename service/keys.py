"""Keys: who may use the service; made by `risorius keys add NAME` or named in the environment.

A key is 256 random bits. What is kept of it is its SHA-256: a slow hash guards passwords, which can
be guessed, and would be paid at every request.
"""

from __future__ import annotations

import hashlib
import ipaddress
import re
import secrets
import time
from collections.abc import Iterable, Mapping
from dataclasses import replace

from .quotas import Allowance, Quota
from .settings import Settings
from .store import ClipRow, KeyRow, Store

PREFIX = "rsr_"
NAME = r"[A-Za-z0-9][A-Za-z0-9._-]{0,31}"
FIRST = "first"
"""Name of the key that a new service makes by itself."""
_ID_BYTES = 4
_SECRET_BYTES = 32
# No name of a stored key begins so: what these keys made stays theirs for as long as they are set.
_FROM_ENVIRONMENT = "env:"
_QUOTA = ("sessions", "viewers", "clip_seconds", "upload_bytes")


class KeyRefused(Exception):
    """A key that cannot be made or taken away; the message is one sentence."""


def add_key(store: Store, name: str, quota: Mapping[str, float | None] | None = None) -> str:
    """Make a key, keep its hash, and return it: it is not known to anybody else from then on.

    Args:
        store: Where it is kept.
        name: Whose it is.
        quota: Of `Quota` what is to be otherwise than by default.

    Raises:
        KeyRefused: If the name is none, or there is a key of it.
    """
    if re.fullmatch(NAME, name) is None:
        raise KeyRefused(
            f"{name!r} names no key; expected 1 to 32 letters, digits, '.', '_' or '-', "
            "a letter or digit first"
        )
    key_id = secrets.token_hex(_ID_BYTES)
    key = f"{PREFIX}{key_id}_{secrets.token_hex(_SECRET_BYTES)}"
    if not store.add_key(name, key_id=key_id, digest=_digest(key), quota=quota or {}):
        raise KeyRefused(f"There is a key named {name!r}; remove it first, or choose another name")
    return key


def remove_key(store: Store, name: str) -> None:
    """Take a key away; what it made stays, for a key of the same name.

    Raises:
        KeyRefused: If there is none of that name.
    """
    if not store.remove_key(name):
        known = ", ".join(row.name for row in store.keys()) or "none at all"
        raise KeyRefused(f"There is no key named {name!r}; there is {known}")


def first_key(store: Store, settings: Settings) -> str | None:
    """Return a key made for a service that has none and asks for one; None where there is any."""
    if not settings.make_key or settings.api_keys or store.keys():
        return None
    return add_key(store, FIRST)


def is_loopback(host: str) -> bool:
    """Return whether an address is reached from this machine alone."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


class KeyRing:
    """The keys that are known now, in memory: no request waits for a database."""

    def __init__(self, settings: Settings) -> None:
        """Take the keys of the environment; those of the store come by `load`."""
        self._defaults = Quota(
            settings.key_sessions,
            settings.key_viewers,
            settings.key_clip_seconds,
            settings.key_upload_bytes,
        )
        self._allowances: dict[str, Allowance] = {}
        self._names: frozenset[str] = frozenset()
        self._stored: dict[str, KeyRow] = {}
        self._environment = {
            _digest(key): f"{_FROM_ENVIRONMENT}{_digest(key)[:12]}" for key in settings.api_keys
        }
        # Where a key was asked for, everybody is not let in when the last one is taken away.
        self._closed = bool(self._environment) or not is_loopback(settings.host)
        self.load(())

    @property
    def required(self) -> bool:
        """Whether a key is asked for: where there is or was one, or others can reach the place."""
        return self._closed

    def load(self, rows: Iterable[KeyRow]) -> set[str]:
        """Take the keys of the store; return the names of those that are gone.

        With the first key nobody's is gone: what was made without one.
        """
        stored = {row.id: row for row in rows}
        gone = {row.name for key_id, row in self._stored.items() if key_id not in stored}
        for name in self._environment.values():
            self._allow(name, self._defaults)
        for row in stored.values():
            own = {name: getattr(row, name) for name in _QUOTA if getattr(row, name) is not None}
            self._allow(row.name, replace(self._defaults, **own))
        self._stored = stored
        self._names = frozenset((*self._environment.values(), *(r.name for r in stored.values())))
        if stored and not self._closed:
            self._closed = True
            gone.add("")
        return gone

    def find(self, key: str) -> str | None:
        """Return the name of a key, None if it is none; how long it takes tells nothing of others.

        The id in a key says which hash to compare with; its secret is only ever compared.
        """
        digest, found = _digest(key), None
        row = self._stored.get(key.removeprefix(PREFIX).partition("_")[0])
        if row is not None and secrets.compare_digest(digest, row.digest):
            found = row.name
        for known, name in self._environment.items():
            if secrets.compare_digest(digest, known):
                found = name
        return found

    def allowance(self, name: str) -> Allowance | None:
        """Return what a key may take, None if there is none of that name now."""
        return self._allowances[name] if name in self._names else None

    def remember(self, clips: Iterable[ClipRow]) -> None:
        """Count the clips of the last hour that a service before this one was asked for."""
        now = time.time()
        for row in clips:
            if row.made_by in self._allowances:
                seconds = float(row.request.get("duration", 0.0))
                self._allowances[row.made_by].clips.remember(seconds, now - row.created)

    def _allow(self, name: str, quota: Quota) -> None:
        """Note what a key may take; what it took stays taken."""
        if name in self._allowances:
            self._allowances[name].quota = quota
        else:
            self._allowances[name] = Allowance(quota)


def _digest(key: str) -> str:
    return hashlib.sha256(key.encode("utf-8", "surrogatepass")).hexdigest()
