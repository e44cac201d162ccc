# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The proxies as ParaView sees them: defaults, names, domains, state files, trace, animation."""

import pathlib
import re

import pytest
from paraview import servermanager, simple, smstate, smtrace
from undecimate import vtkUndecimateFilters

PLATE = str(pathlib.Path(__file__).resolve().parents[2] / "Data" / "plate_hole.vtp")
FILTERS = ["HashQueueDecimation", "TriQuadDecimation", "Undecimation"]
RESULTS = {
    "HashQueueDecimation": {
        "NumberOfInputNodes",
        "NumberOfInputTriangles",
        "NumberOfNodes",
        "NumberOfTriangles",
        "Error",
        "StopReason",
    },
    "TriQuadDecimation": {
        "NumberOfInputNodes",
        "NumberOfInputCells",
        "NumberOfNodes",
        "NumberOfTriangles",
        "NumberOfQuads",
        "Error",
        "StopReason",
        "UsedSteps",
    },
    "Undecimation": {"NumberOfNodes", "NumberOfTriangles", "NumberOfQuads", "Error"},
}


@pytest.fixture(autouse=True)
def empty_session():
    yield
    simple.ResetSession()


def prototype(name):
    return servermanager.ProxyManager().SMProxyManager.GetPrototypeProxy("filters", name)


def properties(name):
    """All properties but the input, by name."""
    proxy = prototype(name)
    found = {}
    iterator = proxy.NewPropertyIterator()
    iterator.Begin()
    while not iterator.IsAtEnd():
        if iterator.GetKey() != "Input":
            found[iterator.GetKey()] = iterator.GetProperty()
        iterator.Next()
    return found


def elements(prop):
    return [prop.GetElement(i) for i in range(prop.GetNumberOfElements())]


@pytest.mark.parametrize("name", FILTERS)
def test_defaults_are_those_of_the_class(name):
    instance = getattr(vtkUndecimateFilters, "vtk" + name)()
    compared = 0
    for key, prop in properties(name).items():
        if prop.GetInformationOnly():
            continue
        if key in ("Scalars", "Steps"):
            assert elements(prop) == [] and getattr(instance, "GetNumberOf" + key)() == 0
        elif key == "Displacement":
            assert elements(prop) == [""] and instance.GetDisplacement() is None
        else:
            assert elements(prop) == [getattr(instance, "Get" + key)()], key
        compared += 1
    assert compared >= 4


@pytest.mark.parametrize("name", FILTERS)
def test_everything_that_can_be_set_is_a_property(name):
    # What VTK's own superclasses have is not ours to show.
    own = {
        member
        for cls in getattr(vtkUndecimateFilters, "vtk" + name).__mro__
        if "Undecimate" in cls.__module__
        for member in vars(cls)
    }
    setters = {m[3:] for m in own if m.startswith("Set") and not re.match(r"Set\w+To[A-Z]", m)}
    setters |= {m[3:] for m in own if m.startswith("Add")}
    editable = {k for k, p in properties(name).items() if not p.GetInformationOnly()}
    assert setters == editable


@pytest.mark.parametrize("name", FILTERS)
def test_results_are_information_only(name):
    information = {k for k, p in properties(name).items() if p.GetInformationOnly()}
    assert information == RESULTS[name]


@pytest.mark.parametrize("name", FILTERS)
def test_label_is_name(name):
    for key, prop in properties(name).items():
        assert servermanager._make_name_valid(prop.GetXMLLabel()) == key
    assert servermanager._make_name_valid(prototype(name).GetXMLLabel()) == name


@pytest.mark.parametrize("name", FILTERS)
def test_menu_category_and_icons(name):
    hints = prototype(name).GetHints()
    menu = hints.FindNestedElementByName("ShowInMenu")
    assert menu.GetAttribute("category") == "Progressive Mesh"
    icon = pathlib.Path(__file__).resolve().parents[2] / "Plugin" / f"{name}.svg"
    assert menu.GetAttribute("icon") == f":/Undecimate/{icon.name}"
    assert hints.FindNestedElementByName("PipelineIcon").GetAttribute("name").endswith(icon.name)
    assert icon.is_file()


def test_outputs_are_named_and_only_the_first_is_shown():
    decimation = simple.HashQueueDecimation(Input=simple.XMLPolyDataReader(FileName=[PLATE]))
    names = [decimation.SMProxy.GetOutputPortName(i) for i in (0, 1)]
    view = prototype("HashQueueDecimation").GetHints().FindNestedElementByName("View")
    assert names == ["Progressive Mesh", "Coarse Mesh"]
    assert (view.GetAttribute("type"), view.GetAttribute("port")) == ("None", "1")


def test_level_has_a_slider_and_can_be_animated():
    level = properties("Undecimation")["Level"]
    domain = level.FindDomain("vtkSMDoubleRangeDomain")
    assert domain.GetMinimumExists(0) and domain.GetMaximumExists(0)
    assert (domain.GetMinimum(0), domain.GetMaximum(0)) == (0.0, 1.0)
    assert level.GetAnimateable() == 1


@pytest.fixture
def pipeline():
    """Both filters on the plate, no property at its default."""
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    decimation = simple.HashQueueDecimation(
        registrationName="dec",
        Input=plate,
        TargetReduction=0.8,
        TargetNodes=2500,
        TargetTriangles=4000,
        MaximumError=0.5,
        Criterion="Scalar Difference",
        Scalars=["von_mises"],
        ScalarWeight=0.3,
        ShapeWeight=0.05,
        IntervalSpacing="Exponential",
        IntervalNodes=7.5,
        PreserveBoundary=1,
        Parallel=1,
        NumberOfThreads=3,
        Triangulate=1,
        OriginalPointIds=1,
    )
    undecimation = simple.Undecimation(
        registrationName="und",
        Input=decimation,
        Level=0.25,
        LevelBy="Error",
        MaximumError=0.125,
        OriginalPointIds=1,
    )
    undecimation.UpdatePipeline()
    return decimation, undecimation


def values(proxy):
    return {
        key: elements(proxy.SMProxy.GetProperty(key))
        for key, prop in properties(proxy.SMProxy.GetXMLName()).items()
        if not prop.GetInformationOnly()
    }


def test_pipeline_fixture_changes_every_default(pipeline):
    for proxy in pipeline:
        for key, value in values(proxy).items():
            default = elements(properties(proxy.SMProxy.GetXMLName())[key])
            assert value != default, key


def counts(proxy):
    proxy.UpdatePipeline()
    return int(proxy.NumberOfNodes), int(proxy.NumberOfTriangles), float(proxy.Error)


def test_results_follow_each_update(pipeline):
    """Without a call of UpdatePropertyInformation(), which ParaView itself would need."""
    decimation, undecimation = pipeline
    undecimation.LevelBy = "Nodes"
    nodes = []
    for level in 0.0, 1.0, 0.5:
        undecimation.Level = level
        nodes.append(counts(undecimation)[0])
        assert nodes[-1] == undecimation.GetDataInformation().GetNumberOfPoints()
    assert nodes[0] < nodes[2] < nodes[1]
    before = decimation.NumberOfTriangles
    decimation.TargetReduction = 0.4
    decimation.TargetNodes = decimation.TargetTriangles = 0
    undecimation.UpdatePipeline()
    assert before < decimation.NumberOfTriangles
    assert decimation.StopReason == "target reduction"


def test_state_file_keeps_values_and_results(pipeline, tmp_path):
    before = [(values(p), counts(p)) for p in pipeline]
    state = str(tmp_path / "state.pvsm")
    simple.SaveState(state)
    simple.ResetSession()
    simple.LoadState(state)
    after = [simple.FindSource("dec"), simple.FindSource("und")]
    assert [(values(p), counts(p)) for p in after] == before


def test_python_state_keeps_values_and_results(pipeline):
    before = [(values(p), counts(p)) for p in pipeline]
    script = smstate.get_state()
    simple.ResetSession()
    exec(compile(script, "state.py", "exec"), {})
    after = [simple.FindSource("dec"), simple.FindSource("und")]
    assert [(values(p), counts(p)) for p in after] == before


def test_trace_can_be_played():
    smtrace.start_trace()
    plate = simple.XMLPolyDataReader(registrationName="plate", FileName=[PLATE])
    decimation = simple.HashQueueDecimation(
        registrationName="dec", Input=plate, Scalars=["von_mises"]
    )
    undecimation = simple.Undecimation(registrationName="und", Input=decimation, Level=0.5)
    trace = smtrace.stop_trace()
    before = counts(undecimation)
    simple.ResetSession()
    assert "HashQueueDecimation(" in trace and "Undecimation(" in trace
    exec(compile(trace, "trace.py", "exec"), {})
    assert list(simple.FindSource("dec").Scalars) == ["von_mises"]
    assert counts(simple.FindSource("und")) == before


@pytest.mark.parametrize(
    "scalars, expected",
    [
        ("von_mises", ["von_mises"]),
        (["von_mises"], ["von_mises"]),
        (("von_mises",), ["von_mises"]),
        ([], []),
    ],
)
def test_scalars_take_a_name_or_a_list(scalars, expected):
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    for decimation in (
        simple.HashQueueDecimation(Input=plate, Scalars=scalars),
        simple.HashQueueDecimation(Input=plate),
    ):
        decimation.Scalars = scalars
        decimation.UpdatePipeline()
        assert list(decimation.Scalars) == expected
        instance = decimation.GetClientSideObject()
        names = [instance.GetScalars(i) for i in range(instance.GetNumberOfScalars())]
        assert names == expected


def test_scalars_accept_the_association_of_other_filters():
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    decimation = simple.HashQueueDecimation(Input=plate, Scalars=["POINTS", "von_mises"])
    other = simple.HashQueueDecimation(Input=plate, Scalars=["von_mises"])
    assert counts(decimation) == counts(other)
    assert decimation.NumberOfNodes > 0


def test_no_array_is_chosen_at_first():
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    decimation = simple.HashQueueDecimation(Input=plate)
    assert list(decimation.Scalars) == []


def test_scalars_offer_the_point_arrays_of_the_input():
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    plate.UpdatePipeline()
    decimation = simple.HashQueueDecimation(Input=plate)
    domain = decimation.SMProxy.GetProperty("Scalars").GetDomain("array_list")
    offered = {domain.GetString(i) for i in range(domain.GetNumberOfStrings())}
    assert offered == set(plate.PointData.keys())


def test_level_animates():
    plate = simple.XMLPolyDataReader(FileName=[PLATE])
    decimation = simple.HashQueueDecimation(Input=plate)
    undecimation = simple.Undecimation(Input=decimation)
    scene = simple.GetAnimationScene()
    scene.PlayMode = "Sequence"
    scene.NumberOfFrames = 3
    track = simple.GetAnimationTrack("Level", proxy=undecimation)
    track.KeyFrames = [
        simple.CompositeKeyFrame(KeyTime=0.0, KeyValues=[0.0]),
        simple.CompositeKeyFrame(KeyTime=1.0, KeyValues=[1.0]),
    ]
    nodes = []
    scene.GoToFirst()
    for _ in range(3):
        nodes.append(counts(undecimation)[0])
        scene.GoToNext()
    plate_nodes = plate.GetDataInformation().GetNumberOfPoints()
    assert nodes[0] == counts(decimation)[0] < nodes[1] < nodes[2] == plate_nodes
