"""The networks: their sizes, the names and shapes of their weights, and what these mean.

Read this first when you train one. A model's weights are one flat `dict[str, ndarray]`. Names are paths in a
tree, and each leaf is what torch calls it and shaped as torch has it, so that `state_dict()` of modules that
are nested as below is what is stored, without renaming:

    linear        `.weight [out, in]`, `.bias [out]`                     y = x W^T + b
    convolution   `.weight [out, in, width]`, `.bias [out]`              over time, cross-correlation
    LSTM          `.weight_ih_l0 [4N, in]`, `.weight_hh_l0 [4N, N]`, `.bias_ih_l0`, `.bias_hh_l0 [4N]`, `_l1`
    ...
                  gates in the order input, forget, cell, output; one direction; state 0 at a sequence's start

`list_weight_shapes(sizes)` gives every name with its shape, in order; a file that has more, fewer or others
is refused. `initial.make_initial_weights(sizes, seed)` gives weights to begin with. What only training needs
(the head that predicts speeds, running means) has no name here and is not exported.

**What goes in.** All is standardised: poses `[T, X]` (X = 6 numbers a joint) by the model's means and
deviations, audio `[T, A]` (A = 27 mels, 54 with two tracks) in the same way; activity `[T, 4]` (self,
partner, both, none) is as it is. Before a recording begins and after it ends there are rows of
`features.make_silence`. `Control` says how frame t hears them:

    window    what the paper does: `before + 1 + ahead` frames of [audio, activity], frame by frame from the
              past to the future, flat, after the `past` poses, oldest first.
              5 * 54 + 31 * 31 = 1231 numbers for the paper's poses.
    encoder   each frame's [audio, activity, g / ahead] through `control.input` (width 1, ReLU), then
              `control.blocks.i` (width 3, dilations 1, 2, 4, 8), unpadded and residual:
              x <- x[d:-d] + relu(conv(x)). 31 frames become one of `width` numbers. The past poses, flat,
              oldest first, go through `past.0`, ReLU, `past.2` to `width` numbers and are put BEFORE it.

**Look-ahead** g, 0..ahead: of frames after t + g audio and activity are 0 (standardised), in both kinds; the
encoder is told g / ahead (1 where ahead is 0) in its last input, the same for all frames of a window.
Windows of neighbouring frames share their convolutions only where g = ahead: then a whole sequence can be
encoded at once, else each window by itself (`encoder.EncoderHearing`), which costs some 6 times as much.

**flow-vae, moglow** (`FlowSizes`). x is a frame, or `span` frames in a row, flat. Its code h `[D]`:

    variational   `encode.0`, ReLU, `encode.2` gives D means, then D logarithms of variances, of a Gaussian;
                  back `decode.0`, ReLU, `decode.2`. In training decoder and flow get a draw from that
                  Gaussian, else its mean. The flow sees (h - code.mean) / code.deviation; with the paper's
                  loss these are 0 and 1.
    autoencoder   the same without the variances: models of earlier versions.
    pca           h = (x - code.mean) @ code.basis^T / code.deviation; basis `[D, X span]`, rows orthonormal.
    none          h = x: MoGlow.

With `guess` the past is the codes before, not the poses: `control.past` of them, oldest first, flat (before
a take those of the pose that it goes on from). A linear guess, by least squares over the takes, comes first:
the flow is on e, with h = guess.weight p + guess.bias + S e, p the past codes, flat, and S the lower triangle
of guess.spread. So e has mean 0 and covariance 1 before anything is learned, whatever the flow then makes of
it, and what is drawn moves as fast and stays as near as the takes do, up to what a linear guess can tell.
ln p(h) has - sum ln |diag S| more. Without `guess`, e = h.

Where `guided`, some stretches of training have audio 0 (standardised), activity as it is. Guidance w draws
twice from the same noise, with memories of their own, without audio (e0) and with it (e1), and goes on with
e0 + w (e1 - e0). With `knots` what is drawn so is made as long as the takes have it: guess.drawn and
guess.true are lengths of e at the same quantiles, as drawn and of the takes learned from. A length between
two of them is interpolated, from 0 on; one beyond the last grows as the last does. They are found after
training (`calibration`), and all 0 before: e stays as it is.

`flow.steps.k`, k = 0 first on the way from e to z (normalising direction):

    actnorm   z <- (z + bias) * exp(logs)
    linear    z <- W z, W = p @ (strictly lower + 1) @ (strictly upper + diag(sign * exp(log_s)));
              p (a permutation) and sign are fixed, of `lower` and `upper` only the strict triangles count
    coupling  a, b = z[: D // 2], z[D // 2 :];  u = out(lstm([a, context])): the first D - D // 2 of u shift,
              the others scale;  b <- (b + shift) * (sigmoid(scale + 2) + 1e-6)

ln p(e) = ln N(z; 0, 1) + sum over steps of (sum logs + sum log_s + sum ln(sigmoid(scale + 2) + 1e-6)).
`out` begins at zero. The LSTMs' state begins at 0 for each training sequence AND for the draw that the third
term of the paper's loss makes; it runs on while sampling. With `span` > 1 a step of time is `span` frames:
its control is that of its first frame, the past poses are the frames before that.

**cvae** (`CvaeSizes`). LSTMs of `layers` layers; `encoder` reads [x, context], `encoder_out` gives mean and
log variance of a code for each frame; `decoder` reads [code, context], `decoder_out` gives x. Control has no
past poses; in the paper's size it is the frame's own 31 numbers. Sampling needs the decoder alone, but both
are kept.

**matching** (`MatchingSizes`). Tokens of `frames` frames: k = (x - tokens.mean) @ tokens.basis^T /
tokens.deviation. Where `around` is not 0 the way back is a linear one from 2 `around` + 1 tokens in a row,
first to last, to the middle one's frames: x = [k ...] @ tokens.joined + tokens.mean, by least squares over
the takes; where it is 0, x = (k * tokens.deviation) @ tokens.basis + tokens.mean, and pieces do not quite
meet, as each lacks the components left out.
A chunk draws `new` tokens at once, from `past` tokens before and the control of all
`past + new + ahead` tokens' frames: [audio, activity, g / most] through `control.input` and `control.blocks`
as above but PADDED with zeros to the same length, then `frames` frames in a row, flat, through
`control.token` to `hidden`. g counts from the chunk's first frame, 0..most = (new + ahead) * frames - 1.
Each token's place has the sum of: `embed_past` of a past token or `embed_new` of x_t (future places have
neither), its control, `place [past + new + ahead, hidden]`. Without past (dropped) every past embedding is
`no_past [hidden]`. Without sound the audio is 0 (standardised) and `no_sound [hidden]` is added to every
control; the activity stays: what guidance exaggerates is the answer to what is heard, not to who speaks.
e = `time.2`(silu(`time.0`([sin, cos of t * 1000 / 10000^(i/F)]))) with F = time // 2, i < F, all sines
first. Block i, `hidden` wide:

    s1, b1, s2, b2 = split(`blocks.i.modulation`(silu(e)))
    x <- x + `proj`(attention(`qkv`(norm(x) * (1 + s1) + b1)))      qkv: all q, then k, then v; heads in a row
    x <- x + `mlp.2`(gelu(`mlp.0`(norm(x) * (1 + s2) + b2)))        gelu: tanh's; norm: without weights, 1e-5
    last: s, b = split(`final.modulation`(silu(e))); v = `final.out`(norm(x) * (1 + s) + b) of the new places

v is the velocity x1 - x0 of x_t = (1 - t) x0 + t x1, x0 ~ N(0, 1), x1 the tokens.
"""

from __future__ import annotations

from math import prod
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct
from numpy.typing import NDArray

Array = NDArray[Any]
Weights = dict[str, Array]
Shapes = dict[str, tuple[int, ...]]

FPS = 25.0  # frames a second of every model
KNOTS = 16  # of the lengths that a new Flow-VAE is brought to
ACTIVITY = 4  # self, partner, both, none
_Count = Annotated[int, Meta(ge=1, le=8192)]
_Some = Annotated[int, Meta(ge=0, le=256)]


class Control(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a network hears. audio: numbers of audio a frame. past: poses (of a flow with a guess: codes)
    before. before, ahead: frames of
    audio and activity before and after. width: of the encoder's layers, and of its two results. dilations:
    of its convolutions of width 3; with kind `encoder` their sum is `before + ahead` over 2.
    """

    kind: Literal["window", "encoder"] = "encoder"
    audio: _Count = 27
    past: _Some = 5
    before: _Some = 5
    ahead: _Some = 25
    width: _Count = 48
    dilations: Annotated[tuple[_Count, ...], Meta(max_length=16)] = (1, 2, 4, 8)

    def __post_init__(self) -> None:
        if self.kind == "encoder" and 2 * sum(self.dilations) != self.before + self.ahead:
            raise ValueError(
                f"convolutions with dilations {list(self.dilations)} read "
                f"{2 * sum(self.dilations) + 1} frames, "
                f"but the window has {self.frames}"
            )

    @property
    def frames(self) -> int:
        """Frames of audio and activity that one frame hears."""
        return self.before + 1 + self.ahead

    @property
    def inputs(self) -> int:
        """Numbers of audio and activity a frame."""
        return self.audio + ACTIVITY

    def of_past(self, pose: int) -> int:
        """Return how many numbers tell the poses before. pose: numbers of a frame's pose."""
        return self.past * pose if self.kind == "window" else self.width * bool(self.past)

    def context(self, pose: int) -> int:
        """Return how many numbers enter the network: of the past, then of what is heard."""
        return self.of_past(pose) + (self.frames * self.inputs if self.kind == "window" else self.width)


class FlowSizes(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag="flow", tag_field="net"):
    """A flow, with or without an autoencoder. pose: numbers a frame. code: what the flow is on. between:
    units of the autoencoder's inner layers. dims: numbers of a code. steps: K. units, layers: of each LSTM.
    span: frames of one step of time. guess: whether the flow is on what a linear guess from past codes lacks.
    guided: whether it has learned some stretches without hearing them, so that it can be guided. knots: of
    the lengths that what the guess lacks is brought to (`calibration`); 0 leaves it as it is drawn.
    """

    pose: _Count = 78
    control: Control = Control()
    code: Literal["variational", "autoencoder", "pca", "none"] = "variational"
    between: _Count = 105
    dims: Annotated[int, Meta(ge=1, le=2048)] = 32
    steps: Annotated[int, Meta(ge=1, le=64)] = 6
    units: _Count = 96
    layers: Annotated[int, Meta(ge=1, le=8)] = 1
    span: Annotated[int, Meta(ge=1, le=16)] = 1
    guess: bool = False
    guided: bool = False
    knots: _Some = 0

    def __post_init__(self) -> None:
        if self.guess and not self.control.past:
            raise ValueError("without past codes there is nothing to guess from")
        if self.knots and not self.guess:
            raise ValueError("lengths are those of what a guess lacks: there is no guess")
        if self.code == "none" and self.dims != self.pose * self.span:
            raise ValueError(
                f"a flow on poses themselves is on {self.pose * self.span} numbers, not on {self.dims}"
            )
        if self.code == "pca" and self.dims > self.pose * self.span:
            raise ValueError(f"{self.pose * self.span} numbers have no {self.dims} components")

    @property
    def told(self) -> int:
        """Numbers of each of the past poses, or codes, that the network gets."""
        return self.dims if self.guess else self.pose

    @property
    def before(self) -> int:
        """Frames before the first one that the past takes."""
        return self.control.past * (self.span if self.guess else 1)


class CvaeSizes(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag="cvae", tag_field="net"):
    """The paper's CVAE. pose: numbers a frame. dims: of a frame's code. units, layers: of both LSTMs."""

    pose: _Count = 78
    control: Control = Control(past=0)
    dims: Annotated[int, Meta(ge=1, le=2048)] = 24
    units: _Count = 96
    layers: Annotated[int, Meta(ge=1, le=8)] = 2

    def __post_init__(self) -> None:
        if self.control.past:
            raise ValueError("the CVAE hears no past poses")


class MatchingSizes(
    Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag="matching", tag_field="net"
):
    """Flow matching on tokens. pose: numbers a frame. frames: of a token. dims: numbers of a token. past,
    new, ahead: tokens. hidden, layers, heads: of the transformer; ratio: how much wider its inner layers
    are. time: numbers that tell t. width, dilations: of the convolutions over the control. around: tokens
    before and after each that tell its frames, too; 0 in the first models.
    """

    pose: _Count = 78
    audio: _Count = 27
    frames: Annotated[int, Meta(ge=1, le=32)] = 4
    dims: Annotated[int, Meta(ge=1, le=2048)] = 32
    past: Annotated[int, Meta(ge=1, le=64)] = 6
    new: Annotated[int, Meta(ge=1, le=64)] = 8
    ahead: Annotated[int, Meta(ge=0, le=64)] = 6
    hidden: _Count = 96
    layers: Annotated[int, Meta(ge=1, le=64)] = 4
    heads: Annotated[int, Meta(ge=1, le=64)] = 4
    ratio: Annotated[int, Meta(ge=1, le=16)] = 4
    time: Annotated[int, Meta(ge=2, le=1024)] = 64
    width: _Count = 48
    dilations: Annotated[tuple[_Count, ...], Meta(max_length=16)] = (1, 2, 4, 8)
    around: Annotated[int, Meta(ge=0, le=8)] = 0

    def __post_init__(self) -> None:
        if self.hidden % self.heads:
            raise ValueError(f"{self.hidden} numbers cannot be shared by {self.heads} heads")
        if self.time % 2:
            raise ValueError("t is told in sines and cosines, an even count")
        if self.dims > self.pose * self.frames:
            raise ValueError(f"{self.pose * self.frames} numbers have no {self.dims} components")

    @property
    def tokens(self) -> int:
        """Places of the transformer."""
        return self.past + self.new + self.ahead

    @property
    def most(self) -> int:
        """The largest look-ahead, frames after a chunk's first."""
        return (self.new + self.ahead) * self.frames - 1


Sizes = FlowSizes | CvaeSizes | MatchingSizes
Kind = Literal["flow-vae", "moglow", "cvae", "matching"]
Size = Literal["small", "paper"]


def make_sizes(
    kind: Kind, size: Size = "small", pose: int = 78, audio: int = 27, as_published: bool = False
) -> Sizes:
    """Return the sizes of a model. pose: numbers a frame (6 a joint). audio: numbers of audio a frame.
    as_published: a small Flow-VAE of single frames, without a guess, as the paper's is built.
    """
    if kind == "matching":
        return MatchingSizes(pose=pose, audio=audio, dims=min(48, 4 * pose), around=1)
    if kind == "cvae":
        if size == "paper":
            own = Control(kind="window", audio=audio, past=0, before=0, ahead=0)
            return CvaeSizes(pose=pose, control=own, dims=35, units=200, layers=5)
        return CvaeSizes(pose=pose, control=Control(audio=audio, past=0))
    if kind == "moglow":
        if size == "paper":
            far = Control(kind="window", audio=audio, ahead=20)
            return FlowSizes(pose=pose, control=far, code="none", dims=pose, steps=16, units=800, layers=2)
        return FlowSizes(pose=pose, control=Control(audio=audio), code="none", dims=pose, steps=6, units=96)
    if size == "paper":
        return FlowSizes(
            pose=pose, control=Control(kind="window", audio=audio), dims=35, steps=8, units=400, layers=2
        )
    if as_published:
        return FlowSizes(pose=pose, control=Control(audio=audio), dims=24, steps=4, units=64)
    far = Control(audio=audio, past=2, before=25, ahead=35, dilations=(1, 2, 4, 8, 15))
    dims = min(48, 8 * pose)
    return FlowSizes(
        pose=pose,
        control=far,
        between=128,
        dims=dims,
        steps=8,
        units=96,
        span=16,
        guess=True,
        guided=True,
        knots=KNOTS,
    )


def list_weight_shapes(sizes: Sizes) -> Shapes:
    """Return the name and shape of every weight, in order."""
    if isinstance(sizes, FlowSizes):
        return _flow(sizes)
    if isinstance(sizes, CvaeSizes):
        return _cvae(sizes)
    return _matching(sizes)


def count_parameters(sizes: Sizes) -> int:
    """Return how many numbers are learned or computed from the data: all but the fixed ones."""
    fixed = (".linear.p", ".linear.sign", "code.mean", "code.deviation")
    out = 0
    for name, shape in list_weight_shapes(sizes).items():
        if name.endswith((".linear.lower", ".linear.upper")):
            out += shape[0] * (shape[0] - 1) // 2
        elif not name.endswith(fixed):
            out += prod(shape)
    return out


def list_linear_shapes(name: str, inputs: int, outputs: int) -> Shapes:
    return {f"{name}.weight": (outputs, inputs), f"{name}.bias": (outputs,)}


def list_lstm_shapes(name: str, inputs: int, units: int, layers: int) -> Shapes:
    out: Shapes = {}
    for n in range(layers):
        out[f"{name}.weight_ih_l{n}"] = (4 * units, units if n else inputs)
        out[f"{name}.weight_hh_l{n}"] = (4 * units, units)
        out[f"{name}.bias_ih_l{n}"] = out[f"{name}.bias_hh_l{n}"] = (4 * units,)
    return out


def _convolutions(inputs: int, width: int, dilations: tuple[int, ...]) -> Shapes:
    out: Shapes = {"control.input.weight": (width, inputs, 1), "control.input.bias": (width,)}
    for n in range(len(dilations)):
        out[f"control.blocks.{n}.weight"] = (width, width, 3)
        out[f"control.blocks.{n}.bias"] = (width,)
    return out


def _control(control: Control, told: int) -> Shapes:
    if control.kind == "window":
        return {}
    out = _convolutions(control.inputs + 1, control.width, control.dilations)
    if control.past:
        out |= list_linear_shapes("past.0", control.past * told, control.width)
        out |= list_linear_shapes("past.2", control.width, control.width)
    return out


def _flow(s: FlowSizes) -> Shapes:
    whole = s.pose * s.span
    out: Shapes = {}
    if s.code in ("variational", "autoencoder"):
        given = 2 * s.dims if s.code == "variational" else s.dims
        out |= list_linear_shapes("encode.0", whole, s.between) | list_linear_shapes(
            "encode.2", s.between, given
        )
        out |= list_linear_shapes("decode.0", s.dims, s.between) | list_linear_shapes(
            "decode.2", s.between, whole
        )
        out |= {"code.mean": (s.dims,), "code.deviation": (s.dims,)}
    elif s.code == "pca":
        out |= {"code.mean": (whole,), "code.basis": (s.dims, whole), "code.deviation": (s.dims,)}
    if s.guess:
        out |= list_linear_shapes("guess", s.control.past * s.dims, s.dims) | {
            "guess.spread": (s.dims, s.dims)
        }
        if s.knots:
            out |= {"guess.drawn": (s.knots,), "guess.true": (s.knots,)}
    out |= _control(s.control, s.told)
    half = s.dims // 2
    for k in range(s.steps):
        step = f"flow.steps.{k}"
        out |= {f"{step}.actnorm.bias": (s.dims,), f"{step}.actnorm.logs": (s.dims,)}
        out |= {f"{step}.linear.{m}": (s.dims, s.dims) for m in ("p", "lower", "upper")}
        out |= {f"{step}.linear.{m}": (s.dims,) for m in ("sign", "log_s")}
        out |= list_lstm_shapes(f"{step}.lstm", half + s.control.context(s.told), s.units, s.layers)
        out |= list_linear_shapes(f"{step}.out", s.units, 2 * (s.dims - half))
    return out


def _cvae(s: CvaeSizes) -> Shapes:
    context = s.control.context(s.pose)
    return {
        **_control(s.control, s.pose),
        **list_lstm_shapes("encoder", s.pose + context, s.units, s.layers),
        **list_linear_shapes("encoder_out", s.units, 2 * s.dims),
        **list_lstm_shapes("decoder", s.dims + context, s.units, s.layers),
        **list_linear_shapes("decoder_out", s.units, s.pose),
    }


def _matching(s: MatchingSizes) -> Shapes:
    out: Shapes = {
        "tokens.mean": (s.frames * s.pose,),
        "tokens.basis": (s.dims, s.frames * s.pose),
        "tokens.deviation": (s.dims,),
    }
    if s.around:
        out["tokens.joined"] = ((2 * s.around + 1) * s.dims, s.frames * s.pose)
    out |= _convolutions(s.audio + ACTIVITY + 1, s.width, s.dilations)
    out |= list_linear_shapes("control.token", s.frames * s.width, s.hidden)
    out |= list_linear_shapes("embed_past", s.dims, s.hidden) | list_linear_shapes(
        "embed_new", s.dims, s.hidden
    )
    out |= {"place": (s.tokens, s.hidden), "no_past": (s.hidden,), "no_sound": (s.hidden,)}
    out |= list_linear_shapes("time.0", s.time, s.time) | list_linear_shapes("time.2", s.time, s.time)
    for n in range(s.layers):
        block = f"blocks.{n}"
        out |= list_linear_shapes(f"{block}.modulation", s.time, 4 * s.hidden)
        out |= list_linear_shapes(f"{block}.qkv", s.hidden, 3 * s.hidden) | list_linear_shapes(
            f"{block}.proj", s.hidden, s.hidden
        )
        out |= list_linear_shapes(f"{block}.mlp.0", s.hidden, s.ratio * s.hidden)
        out |= list_linear_shapes(f"{block}.mlp.2", s.ratio * s.hidden, s.hidden)
    return (
        out
        | list_linear_shapes("final.modulation", s.time, 2 * s.hidden)
        | list_linear_shapes("final.out", s.hidden, s.dims)
    )
