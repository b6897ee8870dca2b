"""Picking in the viewport: each page's own, from its clicks to a measurement on the desk."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import viser
from viser import SceneClickEvent

from app.layers import PICK_COLOUR
from app.measuring import MeasurementDesk
from app.picking import (
    Kind,
    Picking,
    Ray,
    Snap,
    hull_size_m,
    pick_on,
    prepare,
    spec_of,
)
from app.picking_words import STEMS, free_line_name, hint_of
from app.snapshot import Snapshot
from app.viewport_pages import ViewportPages
from core.hull.closed_mesh import Surface
from core.measurement.measuring import measure
from core.measurement.results import Lost

BALL_SHARE = 0.009
"""Radius of what marks a picked point, in sizes of the hull."""

_SNAP_OF_KEYS: tuple[tuple[Literal["shift", "cmd/ctrl"] | None, Snap | None], ...] = (
    (None, None),
    ("shift", "extreme"),
    ("cmd/ctrl", "part end"),
)
"""What held keys snap a click to, None for what the page has chosen."""


@dataclass(slots=True, eq=False)
class _Page:
    picking: Picking | None = None
    client: viser.ClientHandle | None = None
    drawn: int = 0


class Pickers:
    """What each page is picking, whichever viser client it now has.

    A click without movement picks; a drag turns the view as ever. What a click cannot mean is said
    in the state and changes nothing.
    """

    def __init__(
        self,
        pages: ViewportPages,
        surface: Callable[[], Surface | None],
        desk: MeasurementDesk,
        changed: Callable[[], None] = lambda: None,
    ) -> None:
        """Let nobody pick yet.

        Args:
            pages: whose clients are listened to.
            surface: gives the hull that is on show.
            desk: takes complete measurements.
            changed: is called after every change of the facts.
        """
        self._surface = surface
        self._desk = desk
        self._changed = changed
        # Clicks come from viser's threads, orders from the page's requests.
        self._lock = threading.RLock()
        self._pages: dict[str, _Page] = {}
        self._prepared: Surface | None = None
        pages.listen(self._follow_client)

    def facts(self) -> dict[str, Any]:
        """Return what each page that picks has picked, and what it is told."""
        with self._lock:
            surface = self._surface()
            return {
                name: {
                    "kind": picking.kind,
                    "snap": picking.snap,
                    "picked": len(picking.picks),
                    "snaps": picking.is_at_point,
                    "complaint": picking.complaint,
                    "hint": hint_of(picking, surface),
                }
                for name, page in self._pages.items()
                if (picking := page.picking) is not None
            }

    def note(self, snapshot: Snapshot) -> None:
        """Take notice of the hull on show, and make it ready for clicks while somebody picks."""
        with self._lock:
            is_new = snapshot.surface is not self._prepared
        if is_new and self.facts():
            self._prepare()

    def _prepare(self) -> None:
        surface = self._surface()
        with self._lock:
            self._prepared = surface
        if surface is not None and not surface.is_empty:
            threading.Thread(target=prepare, args=(surface,), daemon=True).start()

    def begin(self, name: str, kind: Kind, snap: Snap) -> None:
        """Let a page pick; what it has picked for the same kind stays."""
        self._prepare()
        with self._lock:
            before = self._page(name).picking
            if before is not None and before.kind == kind:
                self._take(name, replace(before, snap=snap, complaint=""))
            else:
                self._take(name, Picking(kind=kind, snap=snap))
        self._changed()

    def stop(self, name: str) -> None:
        """Let a page pick no longer, and forget what it has picked."""
        with self._lock:
            if name in self._pages:
                self._take(name, None)
                if self._pages[name].client is None:
                    del self._pages[name]
        self._changed()

    def take_back(self, name: str) -> None:
        """Forget a page's last pick."""
        with self._lock:
            picking = self._picking(name)
            self._take(name, replace(picking, picks=picking.picks[:-1], complaint=""))
        self._changed()

    def click(self, name: str, ray: Ray, snap: Snap | None = None) -> None:
        """Pick by a ray, and put the measurement on the desk once its picks are complete.

        Args:
            name: of the page.
            ray: through the pointer.
            snap: instead of the page's own.
        """
        with self._lock:
            picking, surface = self._picking(name), self._surface()
            chosen = (snap or picking.snap) if picking.is_at_point else "surface"
            try:
                after = picking.with_pick(pick_on(surface, ray, chosen))
            except ValueError as nothing:
                after = replace(picking, complaint=str(nothing))
            self._take(name, after)
            if not after.complaint and after.is_complete:
                self._finish(name, picking)
        self._changed()

    def finish(self, name: str) -> None:
        """End a polyline with the points that it has."""
        with self._lock:
            picking = self._picking(name)
            if picking.kind == "polyline":
                self._finish(name, picking)
        self._changed()

    def _finish(self, name: str, before: Picking) -> None:
        """Put a page's measurement on the desk and begin anew, or complain and go back."""
        picking, surface = self._picking(name), self._surface()
        if surface is None:
            return
        try:
            spec = spec_of(picking, self._free_name(picking.kind), surface)
            found = measure(spec, surface)
            if isinstance(found, Lost):
                raise ValueError(found.reason)
            self._desk.add(spec)
        except ValueError as refused:
            self._take(name, replace(before, complaint=str(refused)))
        else:
            self._take(name, replace(picking, picks=(), complaint=""))

    def _free_name(self, kind: Kind) -> str:
        if kind == "line feature":
            return free_line_name({item.spec.name for item in self._desk.items})
        return self._desk.free_name(STEMS[kind])

    def _picking(self, name: str) -> Picking:
        picking = self._pages[name].picking if name in self._pages else None
        if picking is None:
            raise ValueError("This page picks nothing; choose what to measure first (M).")
        return picking

    def _page(self, name: str) -> _Page:
        return self._pages.setdefault(name, _Page())

    def _take(self, name: str, picking: Picking | None) -> None:
        page = self._page(name)
        was_picking = page.picking is not None
        page.picking = picking
        if was_picking != (picking is not None):
            self._listen(name, page)
        self._draw(page)

    def _follow_client(self, name: str, client: viser.ClientHandle | None) -> None:
        with self._lock:
            if client is None and name not in self._pages:
                return
            page = self._page(name)
            page.client, page.drawn = client, 0
            if page.picking is not None:
                self._listen(name, page)
                self._draw(page)
            elif client is None:
                del self._pages[name]

    def _listen(self, name: str, page: _Page) -> None:
        """Have a page's clicks told while it picks, and only then."""
        if page.client is None:
            return
        if page.picking is None:
            page.client.scene.remove_click_callback()
            return
        for keys, snap in _SNAP_OF_KEYS:
            page.client.scene.on_click(modifier=keys)(self._clicked(name, snap))

    def _clicked(self, name: str, snap: Snap | None) -> Callable[[SceneClickEvent], None]:
        def clicked(event: SceneClickEvent) -> None:
            origin, direction = np.array(event.ray_origin), np.array(event.ray_direction)
            ray = Ray(origin_m=origin, direction=direction)
            try:
                self.click(name, ray, snap)
            except ValueError:
                return  # it was told to stop in the meantime

        return clicked

    def _draw(self, page: _Page) -> None:
        """Mark on its own page what has been picked."""
        if page.client is None:
            return
        picks = () if page.picking is None else page.picking.picks
        scene, surface = page.client.scene, self._surface()
        with page.client.atomic():
            for number in range(len(picks), page.drawn):
                scene.remove_by_name(f"/picks/{number}")
            if surface is not None and not surface.is_empty:
                radius_m = BALL_SHARE * hull_size_m(surface)
                for number, pick in enumerate(picks):
                    scene.add_icosphere(
                        f"/picks/{number}",
                        radius=radius_m,
                        color=PICK_COLOUR,
                        position=pick.place_m,
                        cast_shadow=False,
                        receive_shadow=False,
                    )
        page.drawn = len(picks)
        page.client.flush()
