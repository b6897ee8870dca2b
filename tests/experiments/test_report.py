import base64
import re

from core.experiments.pictures import Picture
from core.experiments.report import write_report
from core.experiments.results import Figure, Results


def test_a_report_holds_figures_and_pictures_and_no_script(tmp_path):
    results = Results(
        name="check",
        settings={"parts": ["one", "two"], "seed": 1},
        figures=(
            Figure(name="<script>alert(1)</script>", value=2.0, unit="mm", wanted="<= 1 mm"),
            Figure(name="width", value=0.5, unit="mm", wanted="<= 1 mm"),
        ),
    )
    picture = Picture(name="line", caption="A line.", draw=lambda canvas: None, size_in=(2.0, 1.0))
    write_report(tmp_path / "report.html", results, [picture])
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "parts: one, two; seed: 1" in page
    assert 'class="missed"' in page
    assert 'class="met"' in page
    (data,) = re.findall(r"data:image/png;base64,([^\"]+)", page)
    assert base64.b64decode(data).startswith(b"\x89PNG")
    assert not re.findall(r"(?:src|href)=\"(?!data:)", page)
