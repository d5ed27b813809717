// Made from metagraph/speech/gesture_words/*.json; change those, and translate anew.
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>Lexicons of gestures by language, as `GestureWords` has them, with words that say little by themselves. JSON.</summary>
    internal static class GestureWordLists
    {
        public static readonly Dictionary<string, string> Of = new Dictionary<string, string>
        {
            { "de", @"{
""rules"": [
  {""words"": [""hallo"", ""hi"", ""hey"", ""willkommen"", ""guten morgen"", ""guten tag"", ""guten abend"", ""auf wiedersehen"", ""tschüss"", ""bis bald"", ""bis später"", ""servus"", ""freut mich""], ""tags"": [""greeting"", ""open""], ""strength"": 3.0},
  {""words"": [""stopp"", ""warte"", ""warten sie"", ""einen moment"", ""moment mal"", ""es reicht"", ""das reicht""], ""tags"": [""stop"", ""refuse"", ""negative""], ""strength"": 2.6},
  {""words"": [""nein"", ""nicht"", ""nie"", ""niemals"", ""nichts"", ""niemand"", ""kein"", ""keine"", ""keinen"", ""keiner"", ""keinem"", ""nirgends"", ""weder"", ""auf keinen fall""], ""tags"": [""negative"", ""refuse""], ""head"": ""shake"", ""strength"": 1.8},
  {""words"": [""ja"", ""jawohl"", ""genau"", ""natürlich"", ""klar"", ""sicher"", ""absolut"", ""richtig"", ""stimmt"", ""einverstanden"", ""okay"", ""gern"", ""auf jeden fall""], ""tags"": [""agree"", ""positive""], ""head"": ""nod"", ""strength"": 1.6},
  {""words"": [""toll"", ""großartig"", ""wunderbar"", ""wunderschön"", ""hervorragend"", ""fantastisch"", ""super"", ""perfekt"", ""schön"", ""freue"", ""glücklich"", ""froh"", ""liebe"", ""danke"", ""vielen dank"", ""herzlichen dank""], ""tags"": [""positive"", ""open"", ""sincere""], ""head"": ""nod"", ""strength"": 1.8},
  {""words"": [""leid"", ""tut mir leid"", ""entschuldigung"", ""bitte"", ""ehrlich"", ""ehrlich gesagt"", ""wirklich wahr"", ""versprochen"", ""glaub mir"", ""glauben sie mir""], ""tags"": [""sincere"", ""open""], ""strength"": 1.7},
  {""words"": [""vielleicht"", ""möglicherweise"", ""eventuell"", ""wahrscheinlich"", ""ich weiß nicht"", ""weiß nicht"", ""wer weiß"", ""nicht sicher"", ""könnte"", ""kommt darauf an"", ""mag sein""], ""tags"": [""unsure"", ""doubt""], ""strength"": 2.2},
  {""words"": [""egal"", ""ist doch egal"", ""wen kümmert's"", ""vergiss es"", ""vergessen sie es"", ""was soll's"", ""na und""], ""tags"": [""dismissive"", ""negative""], ""strength"": 2.2},
  {""words"": [""erstens"", ""zweitens"", ""drittens"", ""zuerst"", ""zunächst"", ""schließlich"", ""zum einen"", ""zum anderen"", ""erster"", ""zweiter"", ""als erstes"", ""als zweites"", ""zwei dinge"", ""drei dinge""], ""tags"": [""enumerate"", ""beat""], ""strength"": 2.0},
  {""words"": [""aber"", ""jedoch"", ""allerdings"", ""andererseits"", ""auf der anderen seite"", ""obwohl"", ""stattdessen"", ""sondern"", ""dagegen"", ""trotzdem""], ""tags"": [""contrast"", ""other"", ""beat""], ""strength"": 1.5},
  {""words"": [""einerseits"", ""auf der einen seite""], ""tags"": [""contrast"", ""explain"", ""beat""], ""strength"": 1.5},
  {""words"": [""du"", ""dich"", ""dir"", ""dein"", ""deine"", ""deinen"", ""euch"", ""euer""], ""tags"": [""you"", ""open""], ""strength"": 1.1},
  {""words"": [""ich"", ""mich"", ""mir"", ""mein"", ""meine"", ""meinen"", ""meiner""], ""tags"": [""me"", ""sincere""], ""strength"": 0.9},
  {""words"": [""hier"", ""dort"", ""dort drüben"", ""da drüben"", ""dieser da"", ""draußen"", ""dahinter""], ""tags"": [""there"", ""you""], ""strength"": 1.3},
  {""words"": [""groß"", ""große"", ""großen"", ""großer"", ""größer"", ""riesig"", ""riesige"", ""enorm"", ""alles"", ""alle"", ""jeder"", ""ganz"", ""ganze"", ""ganzen"", ""welt"", ""die ganze""], ""tags"": [""big"", ""size"", ""open""], ""strength"": 1.9},
  {""words"": [""klein"", ""kleine"", ""kleinen"", ""winzig"", ""winzige"", ""ein bisschen"", ""ein wenig"", ""genauer"", ""präzise"", ""einzelheit"", ""einzelheiten"", ""detail"", ""details"", ""bestimmte""], ""tags"": [""detail"", ""size""], ""strength"": 1.9},
  {""words"": [""idee"", ""stell dir vor"", ""stellen sie sich vor"", ""plötzlich"", ""was wäre wenn"", ""ich weiß""], ""tags"": [""idea"", ""explain""], ""strength"": 1.9},
  {""words"": [""weil"", ""damit"", ""das heißt"", ""zum beispiel"", ""mit anderen worten"", ""deshalb"", ""darum"", ""der punkt ist"", ""im grunde"", ""siehst du"", ""sehen sie""], ""tags"": [""explain"", ""beat""], ""strength"": 1.4},
  {""words"": [""sehr"", ""wirklich"", ""muss"", ""müssen"", ""immer"", ""meisten"", ""nur"", ""wichtig"", ""wichtige"", ""äußerst"", ""besonders"", ""unbedingt"", ""brauchen"", ""brauche""], ""tags"": [""emphasis"", ""beat""], ""strength"": 1.3},
  {""words"": [""ja klar"", ""von wegen"", ""sogenannte"", ""sogenannten"", ""als ob""], ""tags"": [""irony"", ""dismissive""], ""strength"": 2.3}
],
""question"": {""tags"": [""question"", ""open""], ""strength"": 1.7},
""exclamation"": {""tags"": [""emphasis"", ""beat""], ""strength"": 1.4},
""clause"": {""tags"": [""beat"", ""explain""], ""strength"": 0.6},
""small"": [""ab"", ""aber"", ""alle"", ""alles"", ""als"", ""am"", ""an"", ""ans"", ""auch"", ""auf"", ""aufs"", ""aus"", ""bei"", ""beim"", ""bevor"", ""bin"", ""bis"", ""bist"", ""da"", ""damit"", ""dann"", ""darf"", ""das"", ""dass"", ""dein"", ""deine"", ""deinem"", ""deinen"", ""dem"", ""den"", ""denn"", ""der"", ""des"", ""dich"", ""die"", ""diese"", ""diesem"", ""diesen"", ""dieser"", ""dieses"", ""dir"", ""doch"", ""dort"", ""dran"", ""drauf"", ""du"", ""durch"", ""dürfen"", ""ein"", ""eine"", ""einem"", ""einen"", ""einer"", ""eines"", ""er"", ""es"", ""etwas"", ""euch"", ""euer"", ""eure"", ""falls"", ""für"", ""ganz"", ""gar"", ""gegen"", ""geht's"", ""gibt's"", ""hab"", ""hab's"", ""habe"", ""haben"", ""habt"", ""hast"", ""hat"", ""hatte"", ""hatten"", ""her"", ""hier"", ""hin"", ""hinter"", ""hätte"", ""hätten"", ""ich"", ""ihm"", ""ihn"", ""ihnen"", ""ihr"", ""ihre"", ""ihrem"", ""ihren"", ""ihrer"", ""im"", ""immer"", ""in"", ""ins"", ""ist"", ""ist's"", ""ja"", ""jemand"", ""kann"", ""kannst"", ""kein"", ""keine"", ""keinem"", ""keinen"", ""keiner"", ""konnte"", ""konnten"", ""können"", ""könnte"", ""könnten"", ""mag"", ""mal"", ""man"", ""mehr"", ""mein"", ""meine"", ""meinem"", ""meinen"", ""meiner"", ""mich"", ""mir"", ""mit"", ""muss"", ""musst"", ""musste"", ""möchte"", ""müssen"", ""nach"", ""nachdem"", ""ne"", ""neben"", ""nen"", ""nicht"", ""nichts"", ""noch"", ""nur"", ""ob"", ""obwohl"", ""oder"", ""ohne"", ""raus"", ""rein"", ""runter"", ""schon"", ""sehr"", ""seid"", ""sein"", ""seine"", ""seinem"", ""seinen"", ""seiner"", ""seit"", ""selber"", ""selbst"", ""sich"", ""sie"", ""sind"", ""so"", ""sobald"", ""soll"", ""sollen"", ""sollst"", ""sollte"", ""sondern"", ""um"", ""und"", ""uns"", ""unser"", ""unsere"", ""unseren"", ""unter"", ""viel"", ""vom"", ""von"", ""vor"", ""wann"", ""war"", ""war's"", ""waren"", ""warst"", ""warum"", ""was"", ""weil"", ""wem"", ""wen"", ""wenn"", ""wer"", ""werde"", ""werden"", ""wie"", ""wieder"", ""will"", ""willst"", ""wir"", ""wird"", ""wirst"", ""wo"", ""wohl"", ""wollen"", ""wollte"", ""wurde"", ""wurden"", ""während"", ""wäre"", ""wären"", ""würde"", ""würden"", ""zu"", ""zum"", ""zur"", ""zwischen"", ""über""]
}" },
            { "en", @"{
""rules"": [
  {""words"": [""hello"", ""hi"", ""hey"", ""welcome"", ""good morning"", ""good afternoon"", ""good evening"", ""goodbye"", ""bye"", ""see you"", ""nice to meet you""], ""tags"": [""greeting"", ""open""], ""strength"": 3.0},
  {""words"": [""stop"", ""wait"", ""hold on"", ""hang on"", ""that's enough""], ""tags"": [""stop"", ""refuse"", ""negative""], ""strength"": 2.6},
  {""words"": [""no"", ""not"", ""never"", ""nothing"", ""nobody"", ""none"", ""cannot"", ""can't"", ""don't"", ""doesn't"", ""didn't"", ""won't"", ""wouldn't"", ""isn't"", ""aren't"", ""wasn't"", ""neither""], ""tags"": [""negative"", ""refuse""], ""head"": ""shake"", ""strength"": 1.8},
  {""words"": [""yes"", ""yeah"", ""yep"", ""of course"", ""exactly"", ""absolutely"", ""certainly"", ""sure"", ""right"", ""i agree"", ""definitely"", ""okay""], ""tags"": [""agree"", ""positive""], ""head"": ""nod"", ""strength"": 1.6},
  {""words"": [""great"", ""wonderful"", ""excellent"", ""fantastic"", ""love"", ""happy"", ""glad"", ""beautiful"", ""perfect"", ""thank you"", ""thanks"", ""amazing""], ""tags"": [""positive"", ""open"", ""sincere""], ""head"": ""nod"", ""strength"": 1.8},
  {""words"": [""sorry"", ""please"", ""honestly"", ""truly"", ""i promise"", ""believe me""], ""tags"": [""sincere"", ""open""], ""strength"": 1.7},
  {""words"": [""maybe"", ""perhaps"", ""not sure"", ""i guess"", ""i don't know"", ""who knows"", ""probably"", ""might"", ""possibly"", ""it depends""], ""tags"": [""unsure"", ""doubt""], ""strength"": 2.2},
  {""words"": [""whatever"", ""never mind"", ""who cares"", ""forget it""], ""tags"": [""dismissive"", ""negative""], ""strength"": 2.2},
  {""words"": [""first"", ""firstly"", ""second"", ""secondly"", ""third"", ""thirdly"", ""finally"", ""one thing"", ""another thing"", ""two things"", ""three things""], ""tags"": [""enumerate"", ""beat""], ""strength"": 2.0},
  {""words"": [""but"", ""however"", ""on the other hand"", ""although"", ""instead"", ""whereas"", ""rather""], ""tags"": [""contrast"", ""other"", ""beat""], ""strength"": 1.5},
  {""words"": [""on the one hand""], ""tags"": [""contrast"", ""explain"", ""beat""], ""strength"": 1.5},
  {""words"": [""you"", ""your"", ""yours"", ""yourself""], ""tags"": [""you"", ""open""], ""strength"": 1.1},
  {""words"": [""i"", ""me"", ""my"", ""mine"", ""myself""], ""tags"": [""me"", ""sincere""], ""strength"": 0.9},
  {""words"": [""here"", ""there"", ""over there"", ""this one"", ""that one"", ""outside"", ""behind""], ""tags"": [""there"", ""you""], ""strength"": 1.3},
  {""words"": [""big"", ""bigger"", ""biggest"", ""huge"", ""enormous"", ""large"", ""everything"", ""everyone"", ""whole"", ""world"", ""all of""], ""tags"": [""big"", ""size"", ""open""], ""strength"": 1.9},
  {""words"": [""small"", ""tiny"", ""little bit"", ""precise"", ""precisely"", ""detail"", ""details"", ""exact"", ""specific""], ""tags"": [""detail"", ""size""], ""strength"": 1.9},
  {""words"": [""idea"", ""imagine"", ""suddenly"", ""what if"", ""i know""], ""tags"": [""idea"", ""explain""], ""strength"": 1.9},
  {""words"": [""because"", ""so that"", ""which means"", ""for example"", ""in other words"", ""that is why"", ""the point is"", ""you see"", ""basically""], ""tags"": [""explain"", ""beat""], ""strength"": 1.4},
  {""words"": [""very"", ""really"", ""must"", ""always"", ""most"", ""only"", ""important"", ""extremely"", ""especially"", ""need""], ""tags"": [""emphasis"", ""beat""], ""strength"": 1.3},
  {""words"": [""yeah right"", ""as if"", ""so called""], ""tags"": [""irony"", ""dismissive""], ""strength"": 2.3}
],
""question"": {""tags"": [""question"", ""open""], ""strength"": 1.7},
""exclamation"": {""tags"": [""emphasis"", ""beat""], ""strength"": 1.4},
""clause"": {""tags"": [""beat"", ""explain""], ""strength"": 0.6},
""small"": [""a"", ""about"", ""after"", ""am"", ""an"", ""and"", ""are"", ""as"", ""at"", ""be"", ""because"", ""been"", ""before"", ""being"", ""but"", ""by"", ""can"", ""can't"", ""could"", ""couldn't"", ""did"", ""didn't"", ""do"", ""does"", ""doesn't"", ""don't"", ""down"", ""for"", ""from"", ""had"", ""has"", ""have"", ""he"", ""he'll"", ""he's"", ""her"", ""here"", ""him"", ""his"", ""i"", ""i'd"", ""i'll"", ""i'm"", ""i've"", ""if"", ""in"", ""into"", ""is"", ""isn't"", ""it"", ""it's"", ""its"", ""just"", ""may"", ""me"", ""might"", ""must"", ""my"", ""not"", ""of"", ""off"", ""on"", ""or"", ""our"", ""out"", ""over"", ""shall"", ""she"", ""she'll"", ""she's"", ""should"", ""since"", ""so"", ""than"", ""that"", ""that's"", ""the"", ""their"", ""them"", ""then"", ""there"", ""these"", ""they"", ""they'll"", ""they're"", ""they've"", ""this"", ""those"", ""though"", ""through"", ""to"", ""until"", ""up"", ""us"", ""was"", ""wasn't"", ""we"", ""we'll"", ""we're"", ""we've"", ""were"", ""what"", ""when"", ""where"", ""which"", ""while"", ""who"", ""will"", ""with"", ""won't"", ""would"", ""you"", ""you'll"", ""you're"", ""you've"", ""your""]
}" },
            { "es", @"{
""rules"": [
  {""words"": [""hola"", ""buenos días"", ""buenas tardes"", ""buenas noches"", ""bienvenido"", ""bienvenida"", ""bienvenidos"", ""adiós"", ""hasta luego"", ""hasta pronto"", ""encantado"", ""encantada"", ""mucho gusto""], ""tags"": [""greeting"", ""open""], ""strength"": 3.0},
  {""words"": [""espera"", ""espere"", ""un momento"", ""basta"", ""ya basta""], ""tags"": [""stop"", ""refuse"", ""negative""], ""strength"": 2.6},
  {""words"": [""no"", ""nunca"", ""jamás"", ""nada"", ""nadie"", ""ningún"", ""ninguno"", ""ninguna"", ""tampoco"", ""ni"", ""de ninguna manera""], ""tags"": [""negative"", ""refuse""], ""head"": ""shake"", ""strength"": 1.8},
  {""words"": [""sí"", ""exacto"", ""exactamente"", ""claro"", ""por supuesto"", ""desde luego"", ""absolutamente"", ""ciertamente"", ""seguro"", ""de acuerdo"", ""vale"", ""correcto"", ""así es""], ""tags"": [""agree"", ""positive""], ""head"": ""nod"", ""strength"": 1.6},
  {""words"": [""genial"", ""maravilloso"", ""maravillosa"", ""excelente"", ""fantástico"", ""fantástica"", ""estupendo"", ""perfecto"", ""perfecta"", ""feliz"", ""contento"", ""contenta"", ""encanta"", ""amor"", ""hermoso"", ""hermosa"", ""gracias"", ""muchas gracias""], ""tags"": [""positive"", ""open"", ""sincere""], ""head"": ""nod"", ""strength"": 1.8},
  {""words"": [""lo siento"", ""perdón"", ""por favor"", ""sinceramente"", ""honestamente"", ""de verdad"", ""te lo prometo"", ""se lo prometo"", ""créeme"", ""créame""], ""tags"": [""sincere"", ""open""], ""strength"": 1.7},
  {""words"": [""quizás"", ""quizá"", ""tal vez"", ""probablemente"", ""a lo mejor"", ""no sé"", ""no lo sé"", ""quién sabe"", ""no estoy seguro"", ""no estoy segura"", ""podría"", ""depende"", ""posiblemente""], ""tags"": [""unsure"", ""doubt""], ""strength"": 2.2},
  {""words"": [""da igual"", ""no importa"", ""qué más da"", ""olvídalo"", ""olvídelo"", ""a quién le importa""], ""tags"": [""dismissive"", ""negative""], ""strength"": 2.2},
  {""words"": [""primero"", ""primera"", ""segundo"", ""segunda"", ""tercero"", ""en primer lugar"", ""en segundo lugar"", ""luego"", ""después"", ""finalmente"", ""por último"", ""una cosa"", ""dos cosas"", ""tres cosas""], ""tags"": [""enumerate"", ""beat""], ""strength"": 2.0},
  {""words"": [""pero"", ""sin embargo"", ""no obstante"", ""por otro lado"", ""por otra parte"", ""aunque"", ""en cambio"", ""sino"", ""más bien"", ""al contrario"", ""mientras que""], ""tags"": [""contrast"", ""other"", ""beat""], ""strength"": 1.5},
  {""words"": [""por un lado"", ""por una parte""], ""tags"": [""contrast"", ""explain"", ""beat""], ""strength"": 1.5},
  {""words"": [""tú"", ""ti"", ""usted"", ""ustedes"", ""vosotros"", ""tu"", ""tus""], ""tags"": [""you"", ""open""], ""strength"": 1.1},
  {""words"": [""yo"", ""mí"", ""mi"", ""mis"", ""mío"", ""mía"", ""conmigo""], ""tags"": [""me"", ""sincere""], ""strength"": 0.9},
  {""words"": [""aquí"", ""allí"", ""ahí"", ""allá"", ""acá"", ""este"", ""ese"", ""aquel"", ""fuera"", ""detrás""], ""tags"": [""there"", ""you""], ""strength"": 1.3},
  {""words"": [""grande"", ""grandes"", ""gran"", ""enorme"", ""enormes"", ""inmenso"", ""inmensa"", ""todo"", ""todos"", ""toda"", ""todas"", ""entero"", ""entera"", ""mundo"", ""todo el mundo""], ""tags"": [""big"", ""size"", ""open""], ""strength"": 1.9},
  {""words"": [""pequeño"", ""pequeña"", ""pequeños"", ""pequeñas"", ""diminuto"", ""un poco"", ""un poquito"", ""preciso"", ""precisa"", ""precisamente"", ""detalle"", ""detalles""], ""tags"": [""detail"", ""size""], ""strength"": 1.9},
  {""words"": [""idea"", ""imagina"", ""imagine"", ""imagínate"", ""de repente"", ""y si"", ""ya sé""], ""tags"": [""idea"", ""explain""], ""strength"": 1.9},
  {""words"": [""porque"", ""para que"", ""es decir"", ""o sea"", ""por ejemplo"", ""en otras palabras"", ""por eso"", ""la cuestión es"", ""el caso es"", ""ya ves"", ""básicamente""], ""tags"": [""explain"", ""beat""], ""strength"": 1.4},
  {""words"": [""muy"", ""realmente"", ""debe"", ""debo"", ""siempre"", ""más"", ""solo"", ""sólo"", ""importante"", ""importantes"", ""extremadamente"", ""sobre todo"", ""especialmente"", ""necesito"", ""hay que""], ""tags"": [""emphasis"", ""beat""], ""strength"": 1.3},
  {""words"": [""sí claro"", ""como si"", ""supuestamente"", ""supuesto""], ""tags"": [""irony"", ""dismissive""], ""strength"": 2.3}
],
""question"": {""tags"": [""question"", ""open""], ""strength"": 1.7},
""exclamation"": {""tags"": [""emphasis"", ""beat""], ""strength"": 1.4},
""clause"": {""tags"": [""beat"", ""explain""], ""strength"": 0.6},
""small"": [""a"", ""ahí"", ""al"", ""algo"", ""allí"", ""antes"", ""aquel"", ""aquella"", ""aquí"", ""así"", ""aunque"", ""cada"", ""como"", ""con"", ""cuando"", ""cuál"", ""cuándo"", ""cómo"", ""de"", ""del"", ""desde"", ""después"", ""donde"", ""dónde"", ""e"", ""el"", ""ella"", ""ellas"", ""ellos"", ""en"", ""entonces"", ""entre"", ""era"", ""eran"", ""eres"", ""es"", ""esa"", ""esas"", ""ese"", ""eso"", ""esos"", ""esta"", ""estaba"", ""estaban"", ""estamos"", ""estas"", ""este"", ""esto"", ""estos"", ""estoy"", ""está"", ""están"", ""estás"", ""fue"", ""fueron"", ""ha"", ""había"", ""habían"", ""hace"", ""hacer"", ""hacia"", ""han"", ""has"", ""hasta"", ""hay"", ""he"", ""hemos"", ""hizo"", ""iba"", ""la"", ""las"", ""le"", ""les"", ""lo"", ""los"", ""luego"", ""me"", ""mi"", ""mientras"", ""mis"", ""muy"", ""más"", ""mí"", ""nada"", ""ni"", ""no"", ""nos"", ""nosotros"", ""nuestra"", ""nuestro"", ""nuestros"", ""o"", ""os"", ""otra"", ""otro"", ""para"", ""pero"", ""podía"", ""por"", ""porque"", ""porqué"", ""puede"", ""pueden"", ""puedo"", ""pues"", ""que"", ""quien"", ""quiere"", ""quiero"", ""quién"", ""qué"", ""se"", ""según"", ""ser"", ""si"", ""siempre"", ""sin"", ""sino"", ""sobre"", ""somos"", ""son"", ""soy"", ""su"", ""sus"", ""también"", ""tan"", ""te"", ""tengo"", ""tenía"", ""ti"", ""tiene"", ""tienen"", ""toda"", ""todas"", ""todo"", ""todos"", ""tu"", ""tus"", ""tú"", ""u"", ""un"", ""una"", ""unas"", ""unos"", ""usted"", ""ustedes"", ""va"", ""vamos"", ""van"", ""vas"", ""voy"", ""y"", ""ya"", ""yo"", ""él""]
}" },
            { "fr", @"{
""rules"": [
  {""words"": [""bonjour"", ""salut"", ""bonsoir"", ""bienvenue"", ""au revoir"", ""à bientôt"", ""à demain"", ""coucou"", ""enchanté"", ""enchantée"", ""ravi de vous voir""], ""tags"": [""greeting"", ""open""], ""strength"": 3.0},
  {""words"": [""stop"", ""arrêtez"", ""arrête"", ""attends"", ""attendez"", ""un instant"", ""ça suffit""], ""tags"": [""stop"", ""refuse"", ""negative""], ""strength"": 2.6},
  {""words"": [""non"", ""pas"", ""jamais"", ""rien"", ""personne"", ""aucun"", ""aucune"", ""ni"", ""nulle part"", ""pas du tout""], ""tags"": [""negative"", ""refuse""], ""head"": ""shake"", ""strength"": 1.8},
  {""words"": [""oui"", ""ouais"", ""exactement"", ""bien sûr"", ""absolument"", ""certainement"", ""tout à fait"", ""d'accord"", ""évidemment"", ""voilà"", ""c'est vrai"", ""entendu""], ""tags"": [""agree"", ""positive""], ""head"": ""nod"", ""strength"": 1.6},
  {""words"": [""génial"", ""magnifique"", ""merveilleux"", ""excellent"", ""fantastique"", ""parfait"", ""superbe"", ""heureux"", ""heureuse"", ""content"", ""contente"", ""j'adore"", ""aime"", ""beau"", ""belle"", ""merci"", ""merci beaucoup""], ""tags"": [""positive"", ""open"", ""sincere""], ""head"": ""nod"", ""strength"": 1.8},
  {""words"": [""désolé"", ""désolée"", ""pardon"", ""s'il vous plaît"", ""s'il te plaît"", ""honnêtement"", ""franchement"", ""je vous promets"", ""je te promets"", ""croyez-moi"", ""crois-moi""], ""tags"": [""sincere"", ""open""], ""strength"": 1.7},
  {""words"": [""peut-être"", ""probablement"", ""sans doute"", ""je ne sais pas"", ""je sais pas"", ""qui sait"", ""pas sûr"", ""pas sûre"", ""pourrait"", ""ça dépend"", ""possible"", ""il se peut""], ""tags"": [""unsure"", ""doubt""], ""strength"": 2.2},
  {""words"": [""peu importe"", ""tant pis"", ""laisse tomber"", ""laissez tomber"", ""on s'en fiche"", ""qu'importe""], ""tags"": [""dismissive"", ""negative""], ""strength"": 2.2},
  {""words"": [""premièrement"", ""deuxièmement"", ""troisièmement"", ""d'abord"", ""tout d'abord"", ""ensuite"", ""enfin"", ""finalement"", ""premier"", ""deuxième"", ""une chose"", ""deux choses"", ""trois choses""], ""tags"": [""enumerate"", ""beat""], ""strength"": 2.0},
  {""words"": [""mais"", ""cependant"", ""pourtant"", ""toutefois"", ""par contre"", ""en revanche"", ""d'un autre côté"", ""bien que"", ""plutôt"", ""au contraire"", ""alors que""], ""tags"": [""contrast"", ""other"", ""beat""], ""strength"": 1.5},
  {""words"": [""d'un côté"", ""d'une part""], ""tags"": [""contrast"", ""explain"", ""beat""], ""strength"": 1.5},
  {""words"": [""vous"", ""tu"", ""te"", ""toi"", ""votre"", ""vos"", ""ton"", ""ta"", ""tes""], ""tags"": [""you"", ""open""], ""strength"": 1.1},
  {""words"": [""je"", ""j'ai"", ""moi"", ""me"", ""mon"", ""ma"", ""mes""], ""tags"": [""me"", ""sincere""], ""strength"": 0.9},
  {""words"": [""ici"", ""là"", ""là-bas"", ""celui-ci"", ""celui-là"", ""celle-ci"", ""celle-là"", ""dehors"", ""derrière""], ""tags"": [""there"", ""you""], ""strength"": 1.3},
  {""words"": [""grand"", ""grande"", ""grands"", ""grandes"", ""énorme"", ""immense"", ""gros"", ""grosse"", ""tout"", ""tous"", ""toute"", ""toutes"", ""entier"", ""entière"", ""monde"", ""tout le monde""], ""tags"": [""big"", ""size"", ""open""], ""strength"": 1.9},
  {""words"": [""petit"", ""petite"", ""petits"", ""petites"", ""minuscule"", ""un peu"", ""précis"", ""précise"", ""précisément"", ""détail"", ""détails"", ""exact"", ""exacte""], ""tags"": [""detail"", ""size""], ""strength"": 1.9},
  {""words"": [""idée"", ""imaginez"", ""imagine"", ""soudain"", ""tout à coup"", ""et si"", ""je sais""], ""tags"": [""idea"", ""explain""], ""strength"": 1.9},
  {""words"": [""parce que"", ""car"", ""afin que"", ""pour que"", ""c'est-à-dire"", ""par exemple"", ""autrement dit"", ""c'est pourquoi"", ""le fait est"", ""vous voyez"", ""tu vois"", ""en fait""], ""tags"": [""explain"", ""beat""], ""strength"": 1.4},
  {""words"": [""très"", ""vraiment"", ""doit"", ""dois"", ""faut"", ""il faut"", ""toujours"", ""seulement"", ""important"", ""importante"", ""extrêmement"", ""surtout"", ""besoin""], ""tags"": [""emphasis"", ""beat""], ""strength"": 1.3},
  {""words"": [""c'est ça oui"", ""soi-disant"", ""comme si"", ""mais bien sûr""], ""tags"": [""irony"", ""dismissive""], ""strength"": 2.3}
],
""question"": {""tags"": [""question"", ""open""], ""strength"": 1.7},
""exclamation"": {""tags"": [""emphasis"", ""beat""], ""strength"": 1.4},
""clause"": {""tags"": [""beat"", ""explain""], ""strength"": 0.6},
""small"": [""a"", ""ai"", ""allait"", ""aller"", ""allez"", ""allons"", ""alors"", ""après"", ""as"", ""au"", ""aurais"", ""aurait"", ""aussi"", ""aux"", ""avaient"", ""avais"", ""avait"", ""avant"", ""avec"", ""avez"", ""avons"", ""bien"", ""c"", ""car"", ""ce"", ""cela"", ""celle"", ""celui"", ""ces"", ""cet"", ""cette"", ""ceux"", ""chez"", ""comme"", ""comment"", ""d"", ""dans"", ""de"", ""depuis"", ""des"", ""dit"", ""dois"", ""doit"", ""donc"", ""dont"", ""du"", ""elle"", ""elles"", ""en"", ""encore"", ""entre"", ""es"", ""est"", ""et"", ""eu"", ""eux"", ""faire"", ""fais"", ""fait"", ""faut"", ""font"", ""ici"", ""il"", ""ils"", ""j"", ""jamais"", ""je"", ""jusqu"", ""jusque"", ""l"", ""la"", ""le"", ""les"", ""leur"", ""leurs"", ""lorsqu"", ""lorsque"", ""lui"", ""là"", ""m"", ""ma"", ""mais"", ""me"", ""mes"", ""moi"", ""mon"", ""même"", ""n"", ""ne"", ""ni"", ""nos"", ""notre"", ""nous"", ""on"", ""ont"", ""or"", ""ou"", ""où"", ""par"", ""parce"", ""pas"", ""pendant"", ""peu"", ""peut"", ""peuvent"", ""peux"", ""plus"", ""pour"", ""pourquoi"", ""pourrait"", ""pouvait"", ""puis"", ""puisqu"", ""puisque"", ""qu"", ""quand"", ""que"", ""quel"", ""quelle"", ""quelles"", ""quels"", ""qui"", ""quoi"", ""rien"", ""s"", ""sa"", ""sans"", ""se"", ""sera"", ""serais"", ""serait"", ""seront"", ""ses"", ""si"", ""soi"", ""sommes"", ""son"", ""sont"", ""sous"", ""suis"", ""sur"", ""t"", ""ta"", ""te"", ""tes"", ""toi"", ""ton"", ""toujours"", ""tous"", ""tout"", ""toute"", ""toutes"", ""trop"", ""très"", ""tu"", ""un"", ""une"", ""va"", ""vais"", ""vas"", ""vers"", ""veut"", ""veux"", ""vont"", ""vos"", ""votre"", ""vous"", ""y"", ""à"", ""ça"", ""étaient"", ""étais"", ""était"", ""été"", ""êtes"", ""être""]
}" },
        };
    }
}
