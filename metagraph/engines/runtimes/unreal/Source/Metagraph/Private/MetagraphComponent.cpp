#include "MetagraphComponent.h"

#include "Components/SkeletalMeshComponent.h"
#include "GameFramework/Actor.h"
#include "MetagraphAnimInstance.h"
#include "MetagraphAsset.h"
#include "MetagraphPoses.h"

namespace
{
FString RequestOf(const metagraph::List<std::pair<std::string, metagraph::Json>>& Fields)
{
	return MetagraphText::Unreal(metagraph::json::text(metagraph::Json::object(Fields)));
}
} // namespace

UMetagraphComponent::UMetagraphComponent()
{
	PrimaryComponentTick.bCanEverTick = true;
	PrimaryComponentTick.TickGroup = TG_PrePhysics;
}

void UMetagraphComponent::BeginPlay()
{
	UActorComponent::BeginPlay();
	if (AActor* Owner = GetOwner())
	{
		Mesh = Owner->FindComponentByClass<USkeletalMeshComponent>();
	}
	if (Mesh)
	{
		Mesh->AddTickPrerequisiteComponent(this); // so that the pose is this frame's
		if (bDriveMesh && Mesh->GetAnimClass() == nullptr)
		{
			Mesh->SetAnimInstanceClass(UMetagraphAnimInstance::StaticClass());
		}
	}
	Advance(0.0f);
}

void UMetagraphComponent::TickComponent(float DeltaTime, ELevelTick TickType, FActorComponentTickFunction* ThisTickFunction)
{
	UActorComponent::TickComponent(DeltaTime, TickType, ThisTickFunction);
	Advance(DeltaTime);
}

bool UMetagraphComponent::Begin()
{
	if (Character.IsValid())
	{
		return true;
	}
	const TSharedPtr<FMetagraphGraph> Graph = Asset ? Asset->Graph() : nullptr;
	if (!Graph.IsValid())
	{
		return false;
	}
	metagraph::CharacterOptions Options;
	Options.idle = bIdle;
	if (Seed != 0)
	{
		Options.seed = static_cast<std::uint32_t>(Seed);
	}
	metagraph::TalkOptions Words;
	Words.language = MetagraphText::Plain(Language);
	Words.seed = Options.seed.value_or(1);
	Words.name = "said#";
	Character = MakeShared<FMetagraphCharacter>(Graph->Graph, Options, Words);
	Bones = MetagraphPoses::Bones(*Graph->Graph);
	Curves = MetagraphPoses::Curves(*Graph->Graph);
	return true;
}

void UMetagraphComponent::Advance(float Seconds)
{
	if (!Begin())
	{
		return;
	}
	metagraph::Character& Own = Character->Character;
	Own.update(Own.now() + Seconds);
	Show();
	Tell();
}

/** Make this frame's pose, and show what morph targets do. */
void UMetagraphComponent::Show()
{
	metagraph::Character& Own = Character->Character;
	Latest = MetagraphPoses::Made(Bones, Own.pose(bAlive), Curves, Own.morphs(bAlive));
	for (int32 N = 0; Mesh && bMorphTargets && N < Curves.Num(); N++)
	{
		Mesh->SetMorphTarget(Curves[N], Latest->Weights[N], false);
	}
}

void UMetagraphComponent::Tell()
{
	for (const metagraph::Happening& Event : Character->Character.events())
	{
		FMetagraphHappened& Delegate = Event.kind == "begin" ? OnBegin : OnEnd;
		Delegate.Broadcast(
			MetagraphText::Unreal(Event.layer), MetagraphText::Unreal(Event.action), MetagraphText::Unreal(Event.meta));
	}
}

FString UMetagraphComponent::Ask(const FString& Request)
{
	return Begin() ? MetagraphText::Unreal(Character->Character.ask(MetagraphText::Plain(Request))) : FString();
}

TArray<FString> UMetagraphComponent::Hear(const TArray<FString>& Requests)
{
	TArray<FString> Ids;
	for (const FString& Request : Requests)
	{
		Ids.Add(Ask(Request));
	}
	return Ids;
}

FString UMetagraphComponent::Say(const FString& Text)
{
	if (!Begin())
	{
		return FString();
	}
	const std::string Words = MetagraphText::Plain(Text);
	return MetagraphText::Unreal(bGestures ? Character->Talk.say(Words).id : Character->Character.say(Words));
}

TArray<FString> UMetagraphComponent::SayPiece(const FString& Piece, bool bOver)
{
	TArray<FString> Ids;
	if (Begin())
	{
		for (const metagraph::SaidText& Said : Character->Talk.take(MetagraphText::Plain(Piece), bOver))
		{
			Ids.Add(MetagraphText::Unreal(Said.id));
		}
	}
	return Ids;
}

FString UMetagraphComponent::SayLine(const FString& Line)
{
	return Begin() ? MetagraphText::Unreal(Character->Character.say_line(MetagraphText::Plain(Line))) : FString();
}

FString UMetagraphComponent::SaySound(const FString& Id, const TArray<float>& Samples, float Rate)
{
	if (!Begin())
	{
		return FString();
	}
	metagraph::List<double> Plain;
	for (float Sample : Samples)
	{
		Plain.push_back(Sample);
	}
	return MetagraphText::Unreal(Character->Character.say_sound(MetagraphText::Plain(Id), Plain, Rate));
}

FString UMetagraphComponent::LookAt(FVector Place)
{
	if (!Begin())
	{
		return FString();
	}
	const FVector Point = OwnSpace(Place);
	return MetagraphText::Unreal(Character->Character.look(metagraph::Vec{Point.X, Point.Y, Point.Z}));
}

FString UMetagraphComponent::LookAtPoint(const FString& Point)
{
	return Begin() ? MetagraphText::Unreal(Character->Character.look(MetagraphText::Plain(Point))) : FString();
}

FString UMetagraphComponent::Gesture(const TArray<FString>& Tags)
{
	metagraph::List<std::string> Words;
	for (const FString& Tag : Tags)
	{
		Words.push_back(MetagraphText::Plain(Tag));
	}
	return Ask(RequestOf({{"do", "gesture"}, {"tags", metagraph::Json::texts(Words)}}));
}

FString UMetagraphComponent::Stance(const FString& Stance, bool bStay)
{
	return Ask(RequestOf({{"do", "stance"}, {"stance", MetagraphText::Plain(Stance)}, {"stay", bStay}}));
}

FString UMetagraphComponent::PlacePoint(const FString& Point, FVector Place)
{
	const FVector Own = OwnSpace(Place);
	return Ask(RequestOf({
		{"do", "place"},
		{"name", MetagraphText::Plain(Point)},
		{"point", metagraph::Json::list({Own.X, Own.Y, Own.Z})},
	}));
}

FString UMetagraphComponent::Mood(const FString& Mood, float Intensity)
{
	return Ask(RequestOf({{"do", "mood"}, {"mood", MetagraphText::Plain(Mood)}, {"intensity", static_cast<double>(Intensity)}}));
}

FString UMetagraphComponent::Mode(const FString& Mode)
{
	const std::string Name = MetagraphText::Plain(Mode);
	return Ask(RequestOf({{"do", "mode"}, {"mode", Name.empty() ? metagraph::Json() : metagraph::Json(Name)}}));
}

FString UMetagraphComponent::SetParameter(const FString& Parameter, const FMetagraphValue& Value)
{
	return Begin() ? MetagraphText::Unreal(Character->Character.set_parameter(MetagraphText::Plain(Parameter), Value.Value)) : FString();
}

FString UMetagraphComponent::SetParameterNumber(const FString& Parameter, float Value)
{
	return SetParameter(Parameter, {metagraph::Json(static_cast<double>(Value))});
}

FString UMetagraphComponent::SetParameterSwitch(const FString& Parameter, bool bOn)
{
	return SetParameter(Parameter, {metagraph::Json(bOn)});
}

FString UMetagraphComponent::SetParameterChoice(const FString& Parameter, const FString& Choice)
{
	return SetParameter(Parameter, {metagraph::Json(MetagraphText::Plain(Choice))});
}

FString UMetagraphComponent::SetParameterChoices(const FString& Parameter, const TArray<FString>& Choices)
{
	metagraph::List<std::string> Words;
	for (const FString& Choice : Choices)
	{
		Words.push_back(MetagraphText::Plain(Choice));
	}
	return SetParameter(Parameter, {metagraph::Json::texts(Words)});
}

FString UMetagraphComponent::SetParameterPoint(const FString& Parameter, FVector Place)
{
	const FVector Own = OwnSpace(Place);
	return SetParameter(Parameter, {metagraph::Json::list({Own.X, Own.Y, Own.Z})});
}

FString UMetagraphComponent::PlayParameter(const FString& Parameter)
{
	return SetParameter(Parameter, {metagraph::Json()});
}

FString UMetagraphComponent::Interrupt()
{
	return Begin() ? MetagraphText::Unreal(Character->Talk.interrupt()) : FString();
}

FString UMetagraphComponent::Parameter(const FString& Name) const
{
	return Character.IsValid()
		? MetagraphText::Unreal(metagraph::json::text(Character->Character.get_parameter(MetagraphText::Plain(Name))))
		: FString();
}

FVector UMetagraphComponent::OwnSpace(FVector Place) const
{
	return MetagraphSpace::FromUnreal(Mesh ? Mesh->GetComponentTransform().InverseTransformPosition(Place) : Place);
}

FString UMetagraphComponent::Withdraw(const FString& Request)
{
	return Begin() ? MetagraphText::Unreal(Character->Character.withdraw(MetagraphText::Plain(Request))) : FString();
}

FMetagraphAnswer UMetagraphComponent::Answer(const FString& Request) const
{
	FMetagraphAnswer Out;
	if (!Character.IsValid())
	{
		Out.State = TEXT("refused");
		Out.Why = TEXT("the component has no export that can be read");
		return Out;
	}
	const metagraph::Answer Found = Character->Character.answer(MetagraphText::Plain(Request));
	Out.State = MetagraphText::Unreal(Found.state);
	Out.Why = MetagraphText::Unreal(Found.why);
	Out.At = static_cast<float>(Found.at.value_or(-1.0));
	Out.Until = static_cast<float>(Found.until.value_or(-1.0));
	for (const std::string& What : Found.what)
	{
		Out.What.Add(MetagraphText::Unreal(What));
	}
	return Out;
}

FString UMetagraphComponent::Describe() const
{
	return Character.IsValid() ? MetagraphText::Unreal(metagraph::json::text(Character->Character.describe())) : FString();
}

float UMetagraphComponent::Now() const
{
	return Character.IsValid() ? static_cast<float>(Character->Character.now()) : 0.0f;
}
