"""Conversations in ten languages and some others, written by hand: who says what, what of it is a response
and what a hesitation.

A line is a turn: who, ":" or "=" for one that is nothing but a response, and words; <words> hesitate, "|" is
a pause of 0.4 s. Japanese and Chinese are parted as recognisers part them. The next turn starts 0.6 s later.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from metagraph.graph.conversation.model import Segment, Word
from metagraph.graph.vocabulary import is_unspaced
from tests.speech import talk

TALKS = {
    "en": """
A: so I finally called <uh> the landlord about the heating
B= mhm
A: and he told me <um> | that it was not his problem
B= really
A: and he said I should just put on a sweater
B= oh wow
B: did you <er> tell the housing office
A: I wrote to <er> Mister Holloway last week
B= right
A: he was <like> | totally surprised
B= yeah exactly
B: you know what I would do
A= uh-huh
B: I would <hmm> maybe ask a lawyer""",
    "de": """
A: ich wollte gestern <äh> eigentlich zu Herrn Umlauf fahren
B= mhm
A: aber er war um acht schon weg und seine Frau auch
B= ach so
A: und dann hat er <ähm> | seinen Bruder angerufen
B= ja genau
A: der wohnt in Erfurt um die Ecke vom Dom
B= echt
B: und was hat er gesagt
A: <naja> | er meinte dass es <halt> | nicht mehr geht
B= stimmt
A: das ist eh schon lange kaputt und er will umziehen
B= ja ja
B: <öhm> wann denn
A: <hm> ich glaube um Ostern herum
B= okay gut
A: er fragt ob du also mitkommen willst
B= na klar""",
    "fr": """
A: hier j'ai vu <euh> tout le monde au marché
B= ah bon
A: oui il y avait Monsieur Bonnet avec <ben> | ses enfants
B= d'accord
A: et puis ils m'ont dit que l'école allait fermer
B= ouais
A: c'est <euh> | quand même dommage pour les petits
B= oui bien sûr
B: et toi tu en penses quoi de tout ça
A: moi je pense que la mairie devrait <enfin> | faire quelque chose
B= voilà
A: <bah> | on verra bien après les vacances
B= mh
B: d'accord avec toi mais qui va payer le bus
A= c'est vrai
A: il faudrait demander à la région
B= tout à fait""",
    "es": """
A: ayer estuve en <eh> casa de los señores Pardo
B= ajá
A: y me dijeron que la obra <este> | no va a terminar nunca
B= claro
A: porque el arquitecto se fue y este mes no hay nadie
B= no me digas
A: si quieres te cuento lo que pasó después
B= sí
A: <pues> | llamaron al ayuntamiento y nada
B= ya
A: y la vecina dijo que <em> su tejado también se cae
B= madre mía
B: o sea que están todos igual
A= exacto
B: ¿y tú qué vas a hacer?
A: <o sea> | yo me voy a mi pueblo
B= vale vale""",
    "it": """
A: ieri ho incontrato <ehm> la signora Rossi in piazza
B= ah
A: e mi ha detto che suo figlio si sposa a giugno
B= davvero
A: sì perché <cioè> | hanno trovato una casa a Siena
B= certo
A: però il comune non ha ancora <eh> dato i permessi
B= mh mh
A: e allora devono aspettare fino a settembre
B= ho capito
B: e il lavoro di lui com'è andato a finire
A: <allora> | lui lavora sempre con lo zio
B= ah ecco
A: guadagna bene ma non è contento
B= eh già
A: vorrebbe <uhm> aprire un ristorante
B= che bello""",
    "pt": """
A: ontem fui <hã> à casa da Dona Lurdes
B= sim
A: e ela disse que a filha é professora em Coimbra
B= pois é
A: mas o marido <tipo> | não quer sair do Porto
B= a sério
A: então ela vai <ahn> todos os fins de semana
B= claro
A: o comboio é caro e assim não dá para poupar
B= uhum
B: e eles já pensaram em alugar um quarto
A: <é> | acho que ainda não
B= tá bom
A: o pai dela tem um apartamento em Aveiro
B= ah é
A: mas está cheio de coisas velhas né
B= exatamente""",
    "nl": """
A: gisteren ben ik <uh> met Jan naar het ziekenhuis geweest
B= oh
A: want hij had weer last van zijn rug en er was niemand
B= ach
A: en toen zei de dokter dat hij <uhm> | moest blijven
B= echt waar
A: ja maar hij wou <zeg maar> | meteen naar huis
B= tuurlijk
A: zo is hij nou eenmaal dat weet je wel van hem
B= precies
B: en wie zorgt er nu voor de hond
A: <nou> | mijn zus heeft een tuin
B= oké
A: dus die vindt het alleen maar leuk
B= gelukkig
A: hij mag <eh> volgende week weer weg
B= ja ja""",
    "ja": """
A: 昨日 <えーと> 駅 の 前 で 田中 さん に 会った ん です けど
B= へえ
A: 新しい 仕事 を 始めた って 言って いました
B= そう なん です か
A: <あのー> 前 の 会社 は 遠かった から 大変 だった みたい です
B= うん うん
A: それ で <なんか> | 家 から 近い 店 に した そう です
B= なるほど
B: 給料 は どう なん です か
A: <うーん> 少し 下がった らしい です けど
B= 確かに
A: あの 人 は 家族 と いる 時間 が 欲しい って
B= そう です よ ね
A: 奥さん も 喜んで いました
B= はい""",
    "zh": """
A: 昨天 我 <呃> 在 地铁站 碰到 王老师 了
B= 嗯
A: 他 说 他 要 <那个> | 搬 到 成都 去
B= 真的 吗
A: 因为 那个 房子 太 贵 了 他们 住 不起
B= 对 啊
A: <然后> | 他 太太 也 找到 了 新 工作
B= 哦
B: 那 孩子 上学 怎么办
A: <嗯> 我 没 问 他
B= 好 吧
A: 他 这个 人 什么 都 不 着急
B= 是 的
A: <就是> | 以后 见面 就 难 了
B= 没错""",
    "hi": """
A: कल मैं <उम> शर्मा जी के घर गया था
B= अच्छा
A: उन्होंने बताया कि उनका बेटा वापस आ रहा है
B= हाँ
A: वो <मतलब> | अब दिल्ली में काम करेगा
B= ठीक है
A: लेकिन उसकी पत्नी को मुंबई ज़्यादा पसंद है
B= सही बात है
B: तो फिर वे लोग कहाँ रहेंगे
A: <अम्म> अभी कुछ तय नहीं है
B= जी
A: शायद पहले किराए का मकान लेंगे
B= हम्म
A: मतलब समझने में समय तो लगता है
B= बिल्कुल""",
}
# Speakers who go from one language to another: the language most is in.
MIXED = {
    "de, with English": (
        "de",
        """
A: wir hatten gestern das Kickoff Meeting mit dem Team aus London
B= cool
A: und der Product Owner hat <äh> gesagt that's not my scope
B= wow
A: aber er will um jeden Preis das Feature launchen
B= okay
A: ich habe dann <ähm> den Chef gefragt ob wir das machen
B= ja
B: und was hat er so gemeint
A: er hat gesagt let's see next week
B= typisch
A: und er ist um fünf einfach gegangen
B= ach so""",
    ),
    "hi, in Latin letters": (
        "hi",
        """
A: kal main office gaya tha toh boss ne bola ki meeting hai
B= accha
A: aur mujhe <umm> presentation ke baare mein kuch nahi pata tha
B= haan
A: phir maine laptop khola aur sab kuch explain kar diya
B= sahi hai
B: aur boss ko kaisa laga
A: <matlab> | woh bahut khush tha
B= theek hai""",
    ),
    "es, with English": (
        "es",
        """
A: ayer fui al shopping con mi hermana y nos compramos unos jeans
B= ok
A: estaba todo <eh> en sale pero había mucha gente
B= cool
A: y después nos fuimos a comer sushi que estaba so good
B= sí claro
B: y cómo volvieron a casa
A: <este> | en el bus porque el carro no prendía
B= no way""",
    ),
}
# In languages there are no lists of.
OTHERS = {
    "Swedish": """
A: igår var jag hos läkaren eftersom jag hade så ont i ryggen
B= jaha
A: och hon sa att jag måste röra på mig lite mer varje dag
B= just det
B: men du brukar ju gå till jobbet på morgnarna
A: nej inte längre för vi har flyttat ut till skogen
B= okej
B: hur långt är det till bussen därifrån
A: ungefär tjugo minuter om man går fort""",
    "Polish": """
A: wczoraj byłam u lekarza bo strasznie bolały mnie plecy
B= aha
A: i powiedział mi że muszę się więcej ruszać każdego dnia
B= no tak
B: ale przecież zawsze chodziłaś do pracy na piechotę
A: już nie chodzę bo przeprowadziliśmy się za miasto
B= rozumiem
B: to jak teraz dojeżdżasz do biura
A: autobusem ale jeździ tylko dwa razy dziennie""",
    "Korean": """
A: 어제 허리가 너무 아파서 병원에 갔다 왔어요
B= 아 그래요
A: 의사 선생님이 매일 조금씩 걸으라고 하셨어요
B= 네
B: 그래도 회사까지 항상 걸어서 다니셨잖아요
A: 이제는 이사를 해서 버스를 타고 다녀야 해요
B= 그렇구나
B: 버스는 자주 오는 편이에요
A: 아니요 한 시간에 한 대밖에 없어요""",
}


@dataclass(frozen=True)
class Written:
    """words: each side's, by start. responses, hesitations: each side's, from when to when, seconds."""

    words: tuple[list[Word], list[Word]]
    responses: tuple[list[tuple[float, float]], list[tuple[float, float]]]
    hesitations: tuple[list[tuple[float, float]], list[tuple[float, float]]]
    length: float


def _pieces(text: str, letters: bool) -> Iterator[str]:
    """Yield words; letters: each letter of a writing without blanks is one."""
    for word in text.split():
        if letters and any(map(is_unspaced, word.strip("<>"))):
            inner = word.strip("<>")
            for n, c in enumerate(inner):
                mark = "<" if word[0] == "<" and n == 0 else ""
                yield mark + c + (">" if word[-1] == ">" and n == len(inner) - 1 else "")
        else:
            yield word


def written(text: str, form: str = "NFC", letters: bool = False, each: float = 0.25) -> Written:
    """Return a conversation with times. form: of Unicode. letters: Chinese and Japanese letter by letter.
    each: seconds a word lasts; a letter half of that.
    """
    out = Written(([], []), ([], []), ([], []), 0.0)
    at, begun = 0.5, 0.0
    for line in unicodedata.normalize(form, text).strip().splitlines():
        side, answers = "AB".index(line[0]), line[1] == "="
        start = at
        for piece in _pieces(line[2:], letters):
            if piece == "|":
                at += 0.4
                continue
            if piece[0] == "<":
                begun = at
            word = piece.strip("<>")
            length = each / 2 if letters and len(word) == 1 else each
            out.words[side].append(Word(text=word, start=round(at, 3), end=round(at + length, 3)))
            at += length
            if piece[-1] == ">":
                out.hesitations[side].append((begun, at))
        if answers:
            out.responses[side].append((start, at))
        at += 0.6
    return Written(out.words, out.responses, out.hesitations, at)


def spoken(text: str, voice: str) -> tuple[Any, Written]:
    """Return a conversation as eSpeak NG says it, samples `[2, N]` at `talk.RATE`, with the times of its
    words. Skips the test where it is not installed.
    """
    out = Written(([], []), ([], []), ([], []), 0.0)
    sounds: list[tuple[int, float, Any]] = []
    at = 0.5
    for line in unicodedata.normalize("NFC", text).strip().splitlines():
        side, answers, start = "AB".index(line[0]), line[1] == "=", at
        for part in line[2:].split("|"):
            pieces = part.split()
            marked = " ".join(f"<mark name='w'/>{p.strip('<>')}" for p in pieces)
            samples, starts, end = talk.synthesise(
                marked, f"{voice}+f3" if side else voice, 40 + 20 * side, 165
            )
            assert len(starts) == len(pieces), part
            edges = talk.maker._apart(starts, end, pieces)
            sounds.append((side, at, samples))
            for piece, a, b in zip(pieces, edges, edges[1:], strict=False):
                if piece[0] == "<":
                    begun = at + a
                word = Word(text=piece.strip("<>"), start=round(at + a, 3), end=round(at + b, 3))
                out.words[side].append(word)
                if piece[-1] == ">":
                    out.hesitations[side].append((begun, at + b))
            at += end + 0.4
        if answers:
            out.responses[side].append((start, at - 0.4))
        at += 0.2
    samples = 0.0006 * np.random.default_rng(7).standard_normal((2, round((at + 0.5) * talk.RATE)))
    for side, begin, own in sounds:
        first = round(begin * talk.RATE)
        samples[side, first : first + len(own)] += 0.6 * own
    return samples, Written(out.words, out.responses, out.hesitations, at)


@dataclass
class Score:
    """How many responses and hesitations were written, how many of them found, and what was found that is
    none.
    """

    responses: int = 0
    found_responses: int = 0
    false_responses: int = 0
    hesitations: int = 0
    found_hesitations: int = 0
    false_hesitations: int = 0

    def add(self, of: Written, side: int, segments: Sequence[Segment]) -> None:
        for kind, spans in (("response", of.responses[side]), ("hesitation", of.hesitations[side])):
            got = [s for s in segments if s.kind == kind]
            hit = sum(any(s.start < (a + b) / 2 < s.end for s in got) for a, b in spans)
            wrong = sum(not any(a < (s.start + s.end) / 2 < b for a, b in spans) for s in got)
            name = f"{kind}s"
            setattr(self, name, getattr(self, name) + len(spans))
            setattr(self, f"found_{name}", getattr(self, f"found_{name}") + hit)
            setattr(self, f"false_{name}", getattr(self, f"false_{name}") + wrong)
