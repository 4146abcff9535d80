"""The mirror of a model or a segmentation, in 3D Slicer."""

import importlib.util
import json
from pathlib import Path
from typing import Union

import vtk
from MirrorSymmetryLib import Outputs, SymmetryLogic
from MirrorSymmetryLib.logic import DEFAULT_METHOD
from MirrorSymmetryLib.parameter_form import ParameterForm
from MirrorSymmetryLib.requirement import requirements
from MirrorSymmetryLib.surfaces import segments_of
from slicer.i18n import tr as _
from slicer.i18n import translate
from slicer.parameterNodeWrapper import parameterNodeWrapper
from slicer.ScriptedLoadableModule import (
    ScriptedLoadableModule,
    ScriptedLoadableModuleLogic,
    ScriptedLoadableModuleTest,
    ScriptedLoadableModuleWidget,
)
from slicer.util import VTKObservationMixin

import slicer
from slicer import (
    vtkMRMLLinearTransformNode,
    vtkMRMLMarkupsFiducialNode,
    vtkMRMLMarkupsPlaneNode,
    vtkMRMLModelNode,
    vtkMRMLSegmentationNode,
    vtkMRMLTableNode,
)


class MirrorSymmetry(ScriptedLoadableModule):
    """What Slicer shows of the module in its menus."""

    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        self.parent.title = _("Mirror Symmetry")
        self.parent.categories = [translate("qSlicerAbstractCoreModule", "Surface Models")]
        self.parent.dependencies = ["Colors", "Markups", "Models", "Segmentations", "Tables"]
        self.parent.contributors = ["The symsurf authors"]
        self.parent.helpText = _(
            "Finds the mirror of a model or a segment, such as the mid-sagittal plane of a skull: as a "
            "plane, as a transform that lays it at R = 0, and as a model coloured by how far each point "
            "is from where the other side says it should be. Pairs landmarks over it."
        )
        self.parent.acknowledgementText = _("This module calls symsurf.")


@parameterNodeWrapper
class MirrorSymmetryParameterNode:
    """What the panel shows, saved with the scene. ``Outputs`` says what the outputs are."""

    # Without None the wrapper cannot write that there is no node.
    shape: Union[vtkMRMLModelNode, vtkMRMLSegmentationNode, None] = None  # noqa: UP007
    segment: str
    """The ID of a segment."""
    landmarks: vtkMRMLMarkupsFiducialNode
    method: str = DEFAULT_METHOD
    methodParameters: str = "{}"
    """JSON: by method and name those that are not the default."""
    useFaces: bool = True
    plane: vtkMRMLMarkupsPlaneNode
    transform: vtkMRMLLinearTransformNode
    mirror: vtkMRMLModelNode
    asymmetry: vtkMRMLModelNode
    mirroredLandmarks: vtkMRMLMarkupsFiducialNode
    landmarkTable: vtkMRMLTableNode
    symmetries: vtkMRMLTableNode
    table: vtkMRMLTableNode


class MirrorSymmetryWidget(ScriptedLoadableModuleWidget, VTKObservationMixin):
    """The panel."""

    def __init__(self, parent=None):
        ScriptedLoadableModuleWidget.__init__(self, parent)
        VTKObservationMixin.__init__(self)
        self.logic = None
        self._parameterNode = None
        self._parameterNodeGuiTag = None
        self._form = None

    def setup(self):
        """Makes the panel, when the user opens the module for the first time."""
        ScriptedLoadableModuleWidget.setup(self)
        uiWidget = slicer.util.loadUI(self.resourcePath("UI/MirrorSymmetry.ui"))
        self.layout.addWidget(uiWidget)
        self.ui = slicer.util.childWidgetVariables(uiWidget)
        uiWidget.setMRMLScene(slicer.mrmlScene)
        self.logic = MirrorSymmetryLogic()
        self._form = ParameterForm(
            self.ui.parametersCollapsibleButton.layout(), self._onParameterChanged
        )
        self.addObserver(slicer.mrmlScene, slicer.mrmlScene.StartCloseEvent, self.onSceneStartClose)
        self.addObserver(slicer.mrmlScene, slicer.mrmlScene.EndCloseEvent, self.onSceneEndClose)
        self.ui.segmentComboBox.connect("currentIndexChanged(int)", self._onSegmentChanged)
        self.ui.methodComboBox.connect("currentIndexChanged(int)", self._onMethodChanged)
        self.ui.applyButton.connect("clicked(bool)", self.onApplyButton)
        self.initializeParameterNode()

    def cleanup(self):
        """Called when the application closes."""
        self.removeObservers()

    def enter(self):
        """Called each time the user opens the module."""
        self.initializeParameterNode()

    def exit(self):
        """Called each time the user opens another module."""
        self.setParameterNode(None)

    def onSceneStartClose(self, caller, event):
        """The parameter node will be reset."""
        self.setParameterNode(None)

    def onSceneEndClose(self, caller, event):
        """Where the panel is seen it needs a new parameter node at once."""
        if self.parent.isEntered:
            self.initializeParameterNode()

    def initializeParameterNode(self):
        """Shows the parameter node, and the first model where no shape is chosen."""
        self.setParameterNode(self.logic.getParameterNode())
        if not self._parameterNode.shape:
            model = slicer.mrmlScene.GetFirstNodeByClass("vtkMRMLModelNode")
            if model and not model.GetHideFromEditors():
                self._parameterNode.shape = model

    def setParameterNode(self, parameterNode):
        """Shows and observes the parameter node; None: none."""
        if self._parameterNode:
            self._parameterNode.disconnectGui(self._parameterNodeGuiTag)
            self.removeObserver(self._parameterNode, vtk.vtkCommand.ModifiedEvent, self._update)
        self._parameterNode = parameterNode
        if self._parameterNode:
            self._parameterNodeGuiTag = self._parameterNode.connectGui(self.ui)
            self.addObserver(self._parameterNode, vtk.vtkCommand.ModifiedEvent, self._update)
            self._showMethods()
            self._update()

    def onApplyButton(self):
        """Finds the mirror and fills in the outputs; with no output chosen, new ones of the first
        three."""
        with slicer.util.tryWithErrorDisplay(_("The mirror was not found.")):
            self.logic.ensureInstalled(Path(self.resourcePath("requirements.txt")).parent)
            self._showMethods()
            self.logic.addMissingOutputs(self._parameterNode)
            result = self._process()
        self.ui.statusLabel.text = _("Cancelled") if result is None else str(result)

    def _process(self):
        """The result; None where the user has cancelled."""
        import symsurf

        dialog = slicer.util.createProgressDialog(
            labelText=_("Looking for the mirror"), minimumDuration=1000
        )

        def progress(fraction):
            dialog.value = int(100 * fraction)
            slicer.app.processEvents()
            return not dialog.wasCanceled

        try:
            return self.logic.run(self._parameterNode, progress)
        except symsurf.Cancelled:
            return None
        finally:
            dialog.close()

    def _update(self, caller=None, event=None):
        """Shows what follows from the parameter node."""
        shape = self._parameterNode.shape
        self._showSegments(shape)
        self.ui.applyButton.enabled = shape is not None
        self.ui.applyButton.toolTip = (
            _("Find the mirror.") if shape else _("Choose a model or a segmentation.")
        )

    def _showSegments(self, shape):
        has_segments = shape is not None and shape.IsA("vtkMRMLSegmentationNode")
        self.ui.segmentLabel.visible = self.ui.segmentComboBox.visible = has_segments
        segments = segments_of(shape) if has_segments else {}
        _fill(self.ui.segmentComboBox, segments, self._parameterNode.segment)
        if segments and self._parameterNode.segment not in segments:
            self._parameterNode.segment = next(iter(segments))

    def _showMethods(self):
        """Those of symsurf, where it is installed; else the one that is there initially."""
        if importlib.util.find_spec("symsurf") is None:
            _fill(self.ui.methodComboBox, {DEFAULT_METHOD: DEFAULT_METHOD}, DEFAULT_METHOD)
            return
        import symsurf

        titles = {name: each.title for name, each in symsurf.methods().items()}
        _fill(self.ui.methodComboBox, titles, self._parameterNode.method)
        self._showParameters()

    def _showParameters(self):
        import symsurf

        method = self._parameterNode.method
        values = json.loads(self._parameterNode.methodParameters)
        # Pairs of vertices are what no output shows.
        shown = [each for each in symsurf.methods()[method].parameters if each.name != "pairs"]
        self._form.show(shown, values.get(method, {}))

    def _onSegmentChanged(self, index):
        if self._parameterNode and index >= 0:
            self._parameterNode.segment = self.ui.segmentComboBox.itemData(index)

    def _onMethodChanged(self, index):
        if self._parameterNode and index >= 0:
            self._parameterNode.method = self.ui.methodComboBox.itemData(index)
            if importlib.util.find_spec("symsurf") is not None:
                self._showParameters()

    def _onParameterChanged(self):
        values = json.loads(self._parameterNode.methodParameters)
        values[self._parameterNode.method] = self._form.values()
        self._parameterNode.methodParameters = json.dumps(values)


def _fill(comboBox, texts, chosen):
    """Texts by what they stand for; no signal is sent."""
    blocked = comboBox.blockSignals(True)
    comboBox.clear()
    for data, text in texts.items():
        comboBox.addItem(text, data)
    comboBox.currentIndex = max(comboBox.findData(chosen), 0)
    comboBox.blockSignals(blocked)


class MirrorSymmetryLogic(ScriptedLoadableModuleLogic, SymmetryLogic):
    """``SymmetryLogic.process`` for scripts, and what the panel needs of Slicer."""

    def __init__(self):
        ScriptedLoadableModuleLogic.__init__(self)

    def getParameterNode(self):
        """The one of the scene, with its types."""
        return MirrorSymmetryParameterNode(super().getParameterNode())

    def ensureInstalled(self, resources):
        """Installs symsurf where it is missing, after asking; older Slicers have no
        ``slicer.packaging``."""
        needed = requirements(resources)
        if importlib.util.find_spec("slicer.packaging") is not None:
            import slicer.packaging

            slicer.packaging.pip_ensure(needed, requester="MirrorSymmetry")
        elif importlib.util.find_spec("symsurf") is None:
            question = _("The Python package symsurf needs to be installed. Continue?")
            if not slicer.util.confirmOkCancelDisplay(question):
                raise RuntimeError(_("symsurf is not installed"))
            slicer.util.pip_install([str(each) for each in needed])

    def addMissingOutputs(self, parameterNode):
        """New nodes for plane, transform and asymmetry where no output is chosen at all."""
        if any(vars(self.outputsOf(parameterNode)).values()):
            return
        name, add = parameterNode.shape.GetName(), slicer.mrmlScene.AddNewNodeByClass
        parameterNode.plane = add("vtkMRMLMarkupsPlaneNode", _("{name} mirror").format(name=name))
        parameterNode.transform = add(
            "vtkMRMLLinearTransformNode", _("{name} to R = 0").format(name=name)
        )
        parameterNode.asymmetry = add("vtkMRMLModelNode", _("{name} asymmetry").format(name=name))

    def outputsOf(self, parameterNode):
        """The nodes that are chosen."""
        return Outputs(
            plane=parameterNode.plane,
            transform=parameterNode.transform,
            mirror=parameterNode.mirror,
            asymmetry=parameterNode.asymmetry,
            landmarks=parameterNode.mirroredLandmarks,
            landmark_table=parameterNode.landmarkTable,
            symmetries=parameterNode.symmetries,
            table=parameterNode.table,
        )

    def run(self, parameterNode, progress=None):
        """``process`` of what the parameter node says; the asymmetry gets a legend of its colours."""
        outputs = self.outputsOf(parameterNode)
        parameters = json.loads(parameterNode.methodParameters).get(parameterNode.method)
        result = self.process(
            parameterNode.shape,
            outputs,
            segment=parameterNode.segment,
            landmarks=parameterNode.landmarks,
            method=parameterNode.method,
            parameters=parameters,
            use_faces=parameterNode.useFaces,
            progress=progress,
        )
        if outputs.asymmetry is not None:
            colors = slicer.modules.colors.logic()
            legend = colors.AddDefaultColorLegendDisplayNode(outputs.asymmetry)
            legend.SetTitleText(_("Asymmetry, mm"))
        return result


class MirrorSymmetryTest(ScriptedLoadableModuleTest):
    """Runs in Slicer; the logic alone is tested in slicer-core."""

    def setUp(self):
        slicer.mrmlScene.Clear()

    def runTest(self):
        """Every test."""
        self.setUp()
        self.test_mirror_of_an_ellipsoid()
        self.setUp()
        self.test_panel()

    def addEllipsoid(self):
        """A bent ellipsoid, whose one mirror plane is R = 5."""
        source = vtk.vtkParametricEllipsoid()
        source.SetXRadius(30)
        source.SetYRadius(20)
        source.SetZRadius(10)
        surface = vtk.vtkParametricFunctionSource()
        surface.SetParametricFunction(source)
        surface.Update()
        node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", "Ellipsoid")
        node.SetAndObservePolyData(surface.GetOutput())
        node.CreateDefaultDisplayNodes()
        rows = slicer.util.arrayFromModelPoints(node)
        rows[:, 0] += 5
        rows[:, 2] += 0.02 * (rows[:, 1] + 5) ** 2
        slicer.util.arrayFromModelPointsModified(node)
        return node

    def test_mirror_of_an_ellipsoid(self):
        """The plane lies where it should, and the transform lays it at R = 0."""
        self.delayDisplay("A mirror of an ellipsoid")
        logic = MirrorSymmetryLogic()
        logic.ensureInstalled(Path(__file__).parent / "Resources")
        parameterNode = logic.getParameterNode()
        parameterNode.shape = self.addEllipsoid()
        logic.addMissingOutputs(parameterNode)
        result = logic.run(parameterNode)
        self.assertEqual(result.verdict, "found")
        self.assertAlmostEqual(abs(parameterNode.plane.GetNormalWorld()[0]), 1, delta=1e-3)
        self.assertAlmostEqual(parameterNode.plane.GetCenterWorld()[0], 5, delta=0.05)
        matrix = slicer.util.arrayFromTransformMatrix(parameterNode.transform)
        self.assertAlmostEqual((matrix @ (5, 0, 0, 1))[0], 0, delta=0.05)
        self.delayDisplay("Test passed")

    def test_panel(self):
        """A click on Apply does the same."""
        self.delayDisplay("The panel")
        self.addEllipsoid()
        slicer.util.selectModule("MirrorSymmetry")
        widget = slicer.modules.mirrorsymmetry.widgetRepresentation().self()
        self.assertTrue(widget.ui.applyButton.enabled)
        widget.onApplyButton()
        self.assertIn("found", widget.ui.statusLabel.text)
        self.assertIsNotNone(widget._parameterNode.asymmetry)
        self.delayDisplay("Test passed")
