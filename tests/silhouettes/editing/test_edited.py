import numpy as np
import pytest

from core.silhouettes.editing.edited import edited
from tests.silhouettes.editing.shapes import box, silhouette


def test_an_edit_keeps_what_the_outline_claims_and_names_each_tool_once():
    before = silhouette(box(1, 1, 5, 5))
    after = before
    for tool in ["brush", "smooth", "brush", "brush"]:
        after = edited(after, box(1, 1, 6, 6), tool)
    assert (after.claim, after.component, after.image_shape) == ("lit side", "boom", (48, 60))
    assert after.provenance == "drawn; by hand: smooth, brush"
    assert np.array_equal(after.rings[0], box(1, 1, 6, 6)[0])


@pytest.mark.parametrize("tool", ["", " ", "brush, eraser", "a;b"])
def test_a_tool_without_a_plain_name_is_refused(tool):
    with pytest.raises(ValueError, match="needs a name"):
        edited(silhouette(box(1, 1, 5, 5)), (), tool)
